// Makes a page of a report with the viewer, of the samples fin, beam and elbow. It has pictures
// with legends, and the numbers that the viewer saves as CSV.
//   node report.mjs --bin DIR --viewer DIR --out DIR
// Writes OUT/REPORT.md and its pictures. They belong in web-client/docs.

import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {Browser, kDesktop} from './browser.mjs';
import {picture} from './picture_checks.mjs';
import {makeLog, Server} from './programs.mjs';

const {values: options} = parseArgs({
  options: {bin: {type: 'string'}, viewer: {type: 'string'}, out: {type: 'string'}},
});
if (!options.bin || !options.viewer || !options.out) {
  console.error('Usage: node report.mjs --bin DIR --viewer DIR --out DIR');
  process.exit(2);
}

/** A sample, the view of it, and what there is to say. */
const kFigures = [
  {
    mesh: 'fin',
    title: 'Pressure coefficient of a swept fin',
    said: 'The own field `Cp = (Pressure - 1) / 2`, cut in the middle plane.',
    view: {derived: 'Cp = (Pressure - 1) / 2', field: 'Cp', clip: 'y:0.5'},
  },
  {
    mesh: 'beam',
    title: 'Von Mises stress of a cantilever',
    said: 'The stress on the surface.',
    view: {field: 'VonMises', colormap: 'turbo'},
  },
  {
    mesh: 'elbow',
    title: 'Vorticity in a bent pipe',
    said: 'The length of the curl of the velocity, with the flux of the velocity through the cut.',
    view: {field: 'Velocity.vorticity', clip: 'z:0.5', flux: 'Velocity'},
  },
];

/** Runs in the page: a picture as JPEG, as a data address. */
async function jpegOf(png) {
  const bitmap = await createImageBitmap(await (await fetch(png)).blob());
  const {width, height} = bitmap;
  const canvas = Object.assign(document.createElement('canvas'), {width, height});
  canvas.getContext('2d').drawImage(bitmap, 0, 0);
  return canvas.toDataURL('image/jpeg', 0.85);
}

/** The section's CSV as a table. */
function tableOf(csv) {
  const cells = (line) =>
    line.split(/,(?=(?:[^"]*"[^"]*")*[^"]*$)/).map((cell) => cell.replaceAll('"', ''));
  const [titles, ...rows] = csv.trim().split('\r\n').map(cells);
  const brief = (cell) => (Number.isFinite(parseFloat(cell)) ? Number(cell).toPrecision(5) : cell);
  const row = (all) => `| ${all.slice(0, 4).map(brief).join(' | ')} |`;
  return [row(titles), '|---|---|---|---|', ...rows.map(row)].join('\n');
}

mkdirSync(options.out, {recursive: true});
const folders = kFigures.map(({mesh}) => makeLog(options.bin, mesh, options.out).folder);
const server = new Server(options.bin, folders[0], options.viewer);
await server.start();
const browser = await Browser.launch(options.out);
const parts = [
  '# A page of a report',
  'The viewer made these pictures and tables. `tests/browser/report.mjs` makes them again.\n' +
    'Values are exact for the shown mesh. *within* is the known error of the whole.',
];
for (const {mesh, title, said, view} of kFigures) {
  const query = new URLSearchParams({mesh, ...view});
  const viewer = await browser.openSettled(`${server.url}?${query}`, kDesktop);
  const {page} = viewer;
  await page.locator('qtet-viewer summary', {hasText: 'Numbers'}).click();
  await page.locator('qtet-viewer .numbers > div').first().waitFor();
  await viewer.settle();
  const png = await picture(viewer, `report-${mesh}`, {width: 1200, height: 720, title});
  const address = await page.evaluate(jpegOf, `data:image/png;base64,${png.toString('base64')}`);
  const jpeg = Buffer.from(address.split(',')[1], 'base64');
  writeFileSync(join(options.out, `report-${mesh}.jpg`), jpeg);
  const [saved] = await Promise.all([
    page.waitForEvent('download'),
    page.locator('qtet-viewer .save-numbers').click(),
  ]);
  const table = tableOf(readFileSync(await saved.path(), 'utf8'));
  const link = '`?' + decodeURIComponent(String(query)).replaceAll('+', ' ') + '`';
  parts.push(
    `## ${title}`,
    `![${title}](report-${mesh}.jpg)`,
    `${said}\nThe view is\n${link}.`,
    table,
  );
  await browser.closePages();
}
writeFileSync(join(options.out, 'REPORT.md'), parts.join('\n\n') + '\n');
await server.stop?.();
process.exit(0);
