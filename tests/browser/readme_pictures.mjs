// Makes the two pictures of README.md, and prints their captions. The figures in them are those of
// `qtet info`.
//   node readme_pictures.mjs --bin DIR --viewer DIR --out DIR
// Writes OUT/coarse-to-fine.png and OUT/viewer.png of the sample `fin` with its density alone. They
// belong in web-client/docs. tests/documents/readme_test.py compares the captions with the tool.

import {execFileSync} from 'node:child_process';
import {mkdirSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {Browser, kDesktop} from './browser.mjs';
import {makeLog, Server} from './programs.mjs';

const {values: options} = parseArgs({
  options: {bin: {type: 'string'}, viewer: {type: 'string'}, out: {type: 'string'}},
});
if (!options.bin || !options.viewer || !options.out) {
  console.error('Usage: node readme_pictures.mjs --bin DIR --viewer DIR --out DIR');
  process.exit(2);
}
const kLook = 'mesh=fin&field=Density&colormap=turbo&clip=y:0.5';
/** The part of a desktop's picture that has the mesh, and how wide it is in the row, in pixels. */
const kPart = {x: 110, y: 95, width: 840, height: 450};
const kWidth = 364;
/** Shares of the log's bytes: the last level within each is shown. */
const kShares = [0.03, 0.25, 1];
const kViewerShare = 0.4;

mkdirSync(options.out, {recursive: true});
const {folder} = makeLog(options.bin, 'fin', options.out, ['fin'], ['--fields', 'point:Density']);
const tool = join(options.bin, 'qtet');
const log = join(folder, 'fin.qtet');
const {bytes, levels} = JSON.parse(execFileSync(tool, ['info', log, '--json']));
/** Levels that end with a chunk, about where the viewer holds. */
const shown = levels.filter(
  ({cumulativeBytes}, i) => cumulativeBytes !== levels[i + 1]?.cumulativeBytes,
);
const lastWithin = (share) =>
  shown.filter(({cumulativeBytes}) => cumulativeBytes <= share * bytes).at(-1);

const server = new Server(options.bin, folder, options.viewer);
await server.start();
const browser = await Browser.launch(options.out);

/** The viewer as it holds a level, once its lines are there. */
async function hold({tetrahedra}, device) {
  const quality = tetrahedra === levels.at(-1).tetrahedra ? 'full' : `cells:${tetrahedra}`;
  const viewer = await browser.open(`${server.url}?${kLook}&quality=${quality}`, device);
  await viewer.waitForState(quality === 'full' ? 'complete' : 'held');
  await viewer.waitForPicture();
  await viewer.waitForLines();
  return viewer;
}

/** Three figures or more: 6.2 kB, 252 kB. */
const kilobytes = (count) => `${(count / 1000).toFixed(count < 10000 ? 1 : 0)} kB`;
const cells = ({tetrahedra}) => `${tetrahedra.toLocaleString('en-US')} cells`;

/** Runs in the page: the picture without cards and handles, as a data address. */
async function pictureOfCanvas() {
  const blob = await window.qtetViewer.picture();
  return new Promise((resolve) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result);
    reader.readAsDataURL(blob);
  });
}

/**
 * The last level within the share that the viewer holds exactly. A chunk may end within another.
 */
async function place(share) {
  for (let last = lastWithin(share); last; last = shown[shown.indexOf(last) - 1]) {
    const viewer = await hold(last, kDesktop);
    const {tetrahedra} = await viewer.counts();
    const png = await viewer.page.evaluate(pictureOfCanvas);
    await browser.closePages();
    if (tetrahedra === last.tetrahedra) return {level: last, png};
  }
  throw new Error(`no level within ${share} of the bytes is held exactly`);
}

async function coarseToFine() {
  const places = [];
  for (const share of kShares) places.push(await place(share));
  const off = ({error}) =>
    error ? `${(100 * error.fields[0].rms).toPrecision(2)} % off` : 'on its way';
  const figure = ({level, png}, index) =>
    `<figure><div><img src="${png}"></div><figcaption>
       <b>${kilobytes(level.cumulativeBytes)}</b> · ${cells(level)} ·
       ${index === places.length - 1 ? 'as it was' : off(level)}</figcaption></figure>`;
  const scale = kWidth / kPart.width;
  const height = Math.round(kPart.height * scale);
  const page = await browser.blank({
    viewport: {width: places.length * kWidth, height: height + 36},
  });
  await page.setContent(`<style>
      body { margin: 0; display: flex; background: #fff; color: #1a2029; }
      figure { margin: 0; width: ${kWidth}px; font: 15px system-ui, sans-serif; }
      div { overflow: hidden; height: ${height}px; } figcaption { text-align: center; }
      img { display: block; width: ${kDesktop.viewport.width * scale}px;
        margin: ${-kPart.y * scale}px 0 0 ${-kPart.x * scale}px; }
    </style>${places.map(figure).join('')}`);
  await page.waitForFunction(() => [...document.images].every((image) => image.complete));
  await page.screenshot({path: join(options.out, 'coarse-to-fine.png')});
  const list = places.map(({level}) => `${kilobytes(level.cumulativeBytes)} (${cells(level)})`);
  console.log(`coarse-to-fine.png: ${list.join(', ')}`);
}

async function viewerWithCards() {
  const level = lastWithin(kViewerShare);
  const viewer = await hold(level, kDesktop);
  await viewer.screenshot('viewer');
  await browser.closePages();
  console.log(`viewer.png: ${kilobytes(level.cumulativeBytes)} of ${kilobytes(bytes)}`);
}

try {
  await coarseToFine();
  await viewerWithCards();
} finally {
  await browser.close();
  server.kill();
}
for (const name of ['coarse-to-fine', 'viewer']) {
  const size = readFileSync(join(options.out, `${name}.png`)).length;
  console.log(`${name}.png: ${size} bytes`);
}
