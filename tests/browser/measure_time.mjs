// Measures what tests/bench/TIME.md says about playing, and prints the table: headless Chromium,
// software WebGL, everything on this machine.
//   node measure_time.mjs --bin DIR --viewer DIR --out DIR LOG.qtet
// LOG has a series that the page colours by.

import {cpSync, mkdirSync, rmSync} from 'node:fs';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {Browser} from './browser.mjs';
import {rendererMegabytes, workerSeconds} from './browser_processes.mjs';
import {Server} from './programs.mjs';

const {values: options, positionals} = parseArgs({
  allowPositionals: true,
  options: {bin: {type: 'string'}, viewer: {type: 'string'}, out: {type: 'string'}},
});
if (!options.bin || !options.viewer || !options.out || positionals.length !== 1) {
  console.error('Usage: node measure_time.mjs --bin DIR --viewer DIR --out DIR LOG.qtet');
  process.exit(2);
}
const kPlayedMs = 10000;
/** Instants that are not here: the page fetches 32 ahead, and only while it plays. */
const kSought = [300, 500, 700, 900, 350, 550, 750];

const folder = join(options.out, 'logs');
rmSync(folder, {recursive: true, force: true});
mkdirSync(folder, {recursive: true});
cpSync(positionals[0], join(folder, 'series.qtet'));
const rows = [];
const row = (what, bar, value) => rows.push(`| ${what} | ${bar} | ${value} |`);
const server = new Server(options.bin, folder, options.viewer);
await server.start();
const browser = await Browser.launch(options.out);

/** The page counts pictures and the instants in them. */
function watchPictures() {
  window.qtetShown = [];
  const note = () => {
    const {snapshot} = window.qtetViewer.viewing.mesh;
    window.qtetShown.push({at: performance.now(), field: snapshot.color?.field ?? -1});
  };
  document.addEventListener('load', note, true);
  document.addEventListener('refine', note, true);
}

const open = async (words) => {
  const viewer = await browser.open(`${server.url}?mesh=series&${words}`, undefined, watchPictures);
  await viewer.page.waitForFunction(() => window.qtetViewer.viewing?.later, null);
  await viewer.waitForPicture();
  return viewer;
};

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

/** Milliseconds from the change of `time` until its picture is on the screen. */
const seek = (viewer, at) =>
  viewer.page.evaluate(
    (instant) =>
      new Promise((resolve) => {
        const element = window.qtetViewer;
        const {times} = element.viewing.mesh;
        const {time, text} = times[instant];
        const start = performance.now();
        const look = () => {
          const {mesh} = element.viewing;
          const shown = mesh.manifest.fields[mesh.snapshot.color.field].instant.time;
          if (shown !== time) return;
          document.removeEventListener('refine', look, true);
          resolve(performance.now() - start);
        };
        document.addEventListener('refine', look, true);
        element.setAttribute('time', text);
      }),
    at,
  );

async function measureSeek(words, what, bar) {
  const viewer = await open(words);
  await viewer.settle();
  const took = [];
  const used = [];
  for (const at of kSought) {
    await viewer.page.waitForTimeout(3000);
    const before = workerSeconds();
    took.push(await seek(viewer, at));
    used.push(1000 * (workerSeconds() - before));
  }
  const [least, most] = [Math.min(...took), Math.max(...took)].map(Math.round);
  row(
    `seek to an instant that is not here, ${what}`,
    bar,
    `${Math.round(median(took))} ms (${least} to ${most}); the workers' processor time ` +
      `${Math.round(median(used))} ms`,
  );
  await browser.closePages();
}

async function measurePlaying(words, what, bar) {
  const viewer = await open(words);
  await viewer.page.waitForTimeout(5000); // what is ahead comes
  const before = rendererMegabytes();
  await viewer.page.evaluate(() => {
    window.qtetShown.length = 0;
    const root = window.qtetViewer.shadowRoot;
    const speed = root.querySelector('.time select');
    speed.value = '4';
    speed.dispatchEvent(new Event('change'));
    root.querySelector('.time .play').click();
  });
  await viewer.page.waitForTimeout(kPlayedMs);
  const shown = await viewer.page.evaluate(() => window.qtetShown);
  const seconds = (shown.at(-1).at - shown[0].at) / 1000;
  const instants = shown.filter(({field}, i) => i > 0 && field !== shown[i - 1].field).length;
  row(
    `playing ${what}: instants a second`,
    bar,
    `${(instants / seconds).toFixed(1)}; memory of the page ${Math.round(before)} MB before and ` +
      `${Math.round(rendererMegabytes())} MB behind`,
  );
  await browser.closePages();
}

try {
  await measureSeek('quality=full', 'all cells', '200 ms');
  await measureSeek('quality=cells:1', 'base mesh', '200 ms');
  await measurePlaying('quality=full', 'all cells', '10');
  await measurePlaying('quality=cells:1', 'the base mesh', '25');
} finally {
  await browser.close();
  server.kill();
  console.log(['| what | bar | measured |', '|---|---|---|', ...rows].join('\n'));
}
