// Draws a sheet of parts, arrows and streamlines: on a desktop and a phone, light and dark.
//   node flow_sheet.mjs --bin DIR --viewer DIR --out DIR
// Writes OUT/flow.jpg. It belongs in web-client/docs.

import {mkdirSync} from 'node:fs';
import {parseArgs} from 'node:util';
import {Browser, kDesktop, kPhone} from './browser.mjs';
import {makeLog, Server} from './programs.mjs';
import {drawSheet} from './sheet.mjs';

const {values: options} = parseArgs({
  options: {bin: {type: 'string'}, viewer: {type: 'string'}, out: {type: 'string'}},
});
if (!options.bin || !options.viewer || !options.out) {
  console.error('Usage: node flow_sheet.mjs --bin DIR --viewer DIR --out DIR');
  process.exit(2);
}

/** A title, the section that is open, and the view. */
const kRows = [
  [
    'Parts of a planet: the crust is seen through, the core is hidden',
    'parts',
    {mesh: 'ball', parts: 'Layer', 'part-opacity': 'crust=0.3', 'hidden-parts': 'core', clip: 'y'},
  ],
  [
    'Arrows on a cut round a fin',
    'arrows',
    {mesh: 'fin', arrows: 'Velocity', field: 'Pressure', clip: 'y', 'arrow-density': '22'},
  ],
  [
    'Streamlines in a bent pipe',
    'streamlines',
    {mesh: 'elbow', streamlines: 'Velocity', field: 'Velocity', opacity: '0.15', edges: 'off'},
  ],
];
const kColumns = [kDesktop, kPhone].flatMap((device) =>
  ['light', 'dark'].map((colorScheme) => ({...device, colorScheme})),
);
const kTitles = ['desktop, light', 'desktop, dark', 'phone, light', 'phone, dark'];

/** Runs in the page: only this section is open. */
const openAlone = (name) => {
  for (const section of window.qtetViewer.shadowRoot.querySelectorAll('details[data-fold]'))
    section.open = section.dataset.fold === name;
};

mkdirSync(options.out, {recursive: true});
const [{folder}] = ['ball', 'fin', 'elbow'].map((name) => makeLog(options.bin, name, options.out));
const server = new Server(options.bin, folder, options.viewer);
await server.start();
const browser = await Browser.launch(options.out);
const rows = [];
for (const [title, section, view] of kRows) {
  const pictures = [];
  for (const device of kColumns) {
    const viewer = await browser.open(`${server.url}?${new URLSearchParams(view)}`, device);
    await viewer.waitForState('complete');
    await viewer.page.evaluate(openAlone, section);
    await viewer.page.waitForTimeout(1000); // the section's controls are loaded
    await viewer.settle();
    const png = await viewer.page.screenshot();
    pictures.push(`data:image/png;base64,${png.toString('base64')}`);
    await browser.closePages();
  }
  rows.push([title, pictures]);
}
await browser.close();
server.kill();
await drawSheet(options.out, 'flow', kTitles, rows, 330);
