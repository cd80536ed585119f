// Makes the pictures of tests/bench/TIME.md: each feature for series, on a desktop and a phone.
//   node film_of_time.mjs --bin DIR --viewer DIR --out DIR
// Writes OUT/time.jpg of the samples `fin` and `beam`.

import {readFileSync, rmSync} from 'node:fs';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {Browser, kDesktop, kPhone} from './browser.mjs';
import {makeLog, Server} from './programs.mjs';
import {drawSheet} from './sheet.mjs';

const {values: options} = parseArgs({
  options: {bin: {type: 'string'}, viewer: {type: 'string'}, out: {type: 'string'}},
});
if (!options.bin || !options.viewer || !options.out) {
  console.error('Usage: node film_of_time.mjs --bin DIR --viewer DIR --out DIR');
  process.exit(2);
}
const kDevices = {
  light: kDesktop,
  dark: {...kDesktop, colorScheme: 'dark'},
  'phone, light': kPhone,
  'phone, dark': {...kPhone, colorScheme: 'dark'},
};
const kHeight = 320;

async function play({page}) {
  await page.getByRole('button', {name: 'Play', exact: true}).click();
  await page.waitForTimeout(1500);
}

/** The handle of the time bar is drawn to the middle. */
async function scrub({page}) {
  const {x, y, width, height} = await page.locator('qtet-viewer .time input').boundingBox();
  await page.mouse.move(x + 8, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2, y + height / 2, {steps: 5});
  await page.waitForTimeout(300);
}

async function plot({page}) {
  await page.locator('qtet-viewer canvas.scene').focus();
  await page.keyboard.press('i');
  await page.getByRole('button', {name: 'Over time'}).click();
  await page.locator('qtet-viewer .result .status').getByText('from the server').waitFor();
}

const kFeatures = [
  ['It plays; what is here is marked on the bar', 'fin&clip=y:0.5', play],
  ['Scrubbing to an instant', 'fin&clip=y:0.5', scrub],
  ['One point over time', 'fin&clip=y:0.5&time=5', plot],
  ['Displacement moves the mesh', 'beam&time=3&warp=Displacement&rest-edges=on', () => undefined],
];

const logs = join(options.out, 'time');
rmSync(logs, {recursive: true, force: true});
makeLog(options.bin, 'fin', logs, ['fin', '--steps', '24'], ['--fields', 'Density']);
const {folder} = makeLog(options.bin, 'beam', logs, ['beam', '--steps', '24']);
const server = new Server(options.bin, folder, options.viewer);
await server.start();
const browser = await Browser.launch(options.out);
const rows = [];
for (const [what, query, act] of kFeatures) {
  const pictures = [];
  for (const device of Object.values(kDevices)) {
    const viewer = await browser.open(`${server.url}?mesh=${query}`, device);
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    await viewer.settle();
    await act(viewer);
    const name = `time-${rows.length}-${pictures.length}`;
    await viewer.screenshot(name);
    const png = readFileSync(join(options.out, `${name}.png`)).toString('base64');
    pictures.push(`data:image/png;base64,${png}`);
    await browser.closePages();
  }
  rows.push([what, pictures]);
}
await browser.close();
server.kill();
await drawSheet(options.out, 'time', Object.keys(kDevices), rows, kHeight);
