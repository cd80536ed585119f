// Makes the pictures of tests/bench/VIEWER.md: the first seconds over a slow line from three hosts,
// and meshes as they open.
//   node film_strip.mjs --bin DIR --viewer DIR --out DIR [LOG.qtet...]
// Writes OUT/film.jpg of the sample `fin`, and with logs OUT/meshes.jpg.

import {cpSync, mkdirSync, readFileSync, rmSync} from 'node:fs';
import {basename, join} from 'node:path';
import {parseArgs} from 'node:util';
import {Browser, kDesktop, kPhone} from './browser.mjs';
import {makeLog, Server} from './programs.mjs';
import {SlowLine} from './slow_line.mjs';
import {drawSheet} from './sheet.mjs';
import {threeHosts} from './three_hosts.mjs';

const {values: options, positionals} = parseArgs({
  allowPositionals: true,
  options: {bin: {type: 'string'}, viewer: {type: 'string'}, out: {type: 'string'}},
});
if (!options.bin || !options.viewer || !options.out) {
  console.error('Usage: node film_strip.mjs --bin DIR --viewer DIR --out DIR [LOG.qtet...]');
  process.exit(2);
}
const kLine = {bytesPerSecond: 50000, roundTripMs: 300};
const kSeconds = [1, 2, 4, 8];

/** The page as it was painted so many seconds after the navigation: JPEGs, as data addresses. */
async function film(port, path) {
  const line = await SlowLine.open(port, kLine);
  const browser = await Browser.launch(options.out);
  try {
    const page = await browser.blank(kDesktop);
    const session = await page.context().newCDPSession(page);
    const frames = [];
    session.on('Page.screencastFrame', ({data, metadata, sessionId}) => {
      frames.push({data, at: metadata.timestamp});
      void session.send('Page.screencastFrameAck', {sessionId});
    });
    const size = {maxWidth: 1280, maxHeight: 800};
    await session.send('Page.startScreencast', {format: 'jpeg', quality: 90, ...size});
    const start = Date.now() / 1000;
    await page.goto(line.url + path, {waitUntil: 'commit'});
    await page.waitForTimeout(1000 * kSeconds.at(-1) + 500 - (Date.now() - 1000 * start));
    return kSeconds.map((seconds) => {
      const frame = frames.filter(({at}) => at <= start + seconds).at(-1);
      return frame ? `data:image/jpeg;base64,${frame.data}` : null;
    });
  } finally {
    await browser.close();
    line.close();
  }
}

async function filmOfFin() {
  const {name, folder} = makeLog(options.bin, 'fin', options.out);
  const hosts = await threeHosts({...options, logs: [join(folder, `${name}.qtet`)]});
  const rows = [];
  for (const {what, port} of hosts) rows.push([what, await film(port, `?mesh=${name}`)]);
  for (const host of hosts) host.close();
  const titles = kSeconds.map((seconds) => `${seconds} s`);
  await drawSheet(options.out, 'film', titles, rows);
}

/** Each mesh as it opens, once it is whole. */
async function meshes() {
  const folder = join(options.out, 'shown');
  rmSync(folder, {recursive: true, force: true});
  mkdirSync(folder, {recursive: true});
  for (const log of positionals) cpSync(log, join(folder, basename(log)));
  const server = new Server(options.bin, folder, options.viewer);
  await server.start();
  const browser = await Browser.launch(options.out);
  const devices = [kDesktop, {...kDesktop, colorScheme: 'dark'}, kPhone];
  const rows = [];
  for (const log of positionals) {
    const name = basename(log, '.qtet');
    const pictures = [];
    for (const device of devices) {
      const viewer = await browser.open(`${server.url}?mesh=${encodeURIComponent(name)}`, device);
      await viewer.waitForState('complete');
      await viewer.waitForPicture();
      await viewer.waitForLines();
      await viewer.settle();
      await viewer.screenshot(`shown-${name}`);
      const png = readFileSync(join(options.out, `shown-${name}.png`)).toString('base64');
      pictures.push(`data:image/png;base64,${png}`);
      await browser.closePages();
    }
    rows.push([name, pictures]);
  }
  await browser.close();
  server.kill();
  await drawSheet(options.out, 'meshes', ['light', 'dark', 'phone'], rows, 240);
}

await filmOfFin();
if (positionals.length > 0) await meshes();
