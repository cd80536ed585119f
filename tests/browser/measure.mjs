// Measures what tests/bench/VIEWER.md says about the viewer, and prints the table: headless
// Chromium, software WebGL, everything on this machine.
//   QTET_DATA=FOLDER node measure.mjs --bin DIR --viewer DIR --out DIR
// FOLDER holds comb.vtu and post-welded.vtu.

import {execFileSync} from 'node:child_process';
import {existsSync, mkdirSync, statSync} from 'node:fs';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {Browser} from './browser.mjs';
import {graphicsSeconds, rendererMegabytes, workerSeconds} from './browser_processes.mjs';
import {PoorLine} from './poor_line.mjs';
import {Server} from './programs.mjs';

const {values: options} = parseArgs({
  options: {bin: {type: 'string'}, viewer: {type: 'string'}, out: {type: 'string'}},
});
const data = process.env.QTET_DATA;
if (!options.bin || !options.viewer || !options.out || !data) {
  console.error('Usage: QTET_DATA=FOLDER node measure.mjs --bin DIR --viewer DIR --out DIR');
  process.exit(2);
}
const folder = join(options.out, 'logs');
mkdirSync(folder, {recursive: true});
const tool = (...words) => execFileSync(join(options.bin, 'qtet'), words, {stdio: 'pipe'});
const meshes = {
  comb: join(data, 'comb.vtu'),
  'post-welded': join(data, 'post-welded.vtu'),
  'fin-500k': join(options.out, 'fin-500k.vtu'),
};
if (!existsSync(meshes['fin-500k']))
  tool('sample', 'fin', '--cells', '500000', '-o', meshes['fin-500k']);
for (const [name, mesh] of Object.entries(meshes))
  if (!existsSync(join(folder, `${name}.qtet`)))
    tool('simplify', mesh, '-o', join(folder, `${name}.qtet`));

const rows = [];
const row = (what, bar, value) => rows.push(`| ${what} | ${bar} | ${value} |`);
const server = new Server(options.bin, folder, options.viewer);
await server.start();
const browser = await Browser.launch(options.out);

/**
 * The longest tasks of the page's thread between opening and the whole mesh, in time and in
 * processor time.
 */
async function measureLoading() {
  const trace = await browser.trace();
  const viewer = await browser.open(`${server.url}?mesh=post-welded`);
  // The workers get no other command, as settle() would send: a digest of the whole mesh takes
  // memory of the codec that stays.
  await viewer.page.waitForFunction(
    () => window.qtetSeen.events.some(({type}) => type === 'complete'),
    null,
    {timeout: 60000},
  );
  await viewer.page.waitForTimeout(2000);
  const tasks = await trace.end();
  const {events} = await viewer.seen();
  const first = events.find(({type}) => type === 'load');
  const long = (key) =>
    tasks
      .filter((task) => task[key] > 50)
      .map((task) => Math.round(task[key]))
      .sort((a, b) => b - a);
  const listed = (all) => (all.length > 0 ? `${all.length}: ${all.join(', ')} ms` : 'none');
  row(
    'post-welded: tasks of the page above 50 ms, from opening to the whole mesh',
    'none',
    `on the clock ${listed(long('ms'))}; of processor time ${listed(long('cpuMs'))}, the ` +
      `longest ${Math.round(Math.max(...tasks.map(({cpuMs}) => cpuMs)))} ms`,
  );
  row(
    'post-welded: from opening to the whole mesh',
    '',
    `${((events.find(({type}) => type === 'complete')?.at ?? NaN) / 1000).toFixed(1)} s`,
  );
  const share = (100 * first.bytes) / statSync(meshes['post-welded']).size;
  row(
    "post-welded: bytes that the first picture drawn is made of, of the .vtu's",
    '2 %',
    `${first.bytes} bytes, ${share.toFixed(2)} %`,
  );
  const {tetrahedra} = await viewer.counts();
  const large = rendererMegabytes();
  await browser.closePages();
  const small = await browser.open(`${server.url}?mesh=comb&quality=cells:1`);
  await small.waitForState('held');
  await small.settle();
  row(
    'post-welded: memory of the page a cell, above that of a page with a coarse mesh',
    '120 B',
    `${Math.round(((large - rendererMegabytes()) * 2 ** 20) / tetrahedra)} B`,
  );
  await browser.closePages();
}

/**
 * Turns the view by keys while the mesh refines. Measures how long a key waits for the page, and
 * for the next paint (Event Timing, in steps of 8 ms).
 */
async function measureInput() {
  const viewer = await browser.open(`${server.url}?mesh=post-welded`);
  await viewer.page.waitForFunction(
    () => window.qtetSeen.events.some(({type}) => type === 'load'),
    null,
    {timeout: 60000},
  );
  await viewer.page.locator('canvas.scene').focus();
  await viewer.page.evaluate(() => {
    window.qtetKeys = [];
    window.addEventListener(
      'keydown',
      ({timeStamp}) => {
        window.qtetKeys.push({waited: performance.now() - timeStamp, shown: 0, timeStamp});
      },
      true,
    );
    new PerformanceObserver((list) => {
      for (const {name, startTime, duration} of list.getEntries()) {
        const key =
          name === 'keydown' &&
          window.qtetKeys.find(({timeStamp}) => Math.abs(timeStamp - startTime) < 0.5);
        if (key) key.shown = duration;
      }
    }).observe({type: 'event', durationThreshold: 16});
  });
  while (await viewer.page.evaluate(() => window.qtetViewer.state !== 'complete'))
    await viewer.page.keyboard.press('ArrowLeft');
  await viewer.page.waitForTimeout(500);
  const keys = await viewer.page.evaluate(() => window.qtetKeys);
  const text = (values) =>
    `${Math.round(values[values.length >> 1])} ms, at most ${Math.round(values.at(-1))} ms`;
  const sorted = (what) => keys.map((key) => key[what]).sort((a, b) => a - b);
  row(
    'post-welded: a key while it refines waits for the page (median)',
    '',
    `${text(sorted('waited'))}, of ${keys.length} keys`,
  );
  row('- until the page has painted again', '', text(sorted('shown')));
  await browser.closePages();
}

/**
 * Refines from a coarse mesh until everything is decoded: seconds on the clock, and of the workers'
 * processor time.
 */
async function refine(viewer) {
  const before = workerSeconds();
  const seconds = await viewer.page.evaluate(
    () =>
      new Promise((resolve) => {
        const start = performance.now();
        window.qtetViewer.setAttribute('quality', 'full');
        const timer = setInterval(() => {
          if (window.qtetViewer.state !== 'complete') return;
          clearInterval(timer);
          resolve((performance.now() - start) / 1000);
        }, 2);
      }),
  );
  return {seconds, used: workerSeconds() - before};
}

async function measureDecoding() {
  const viewer = await browser.open(`${server.url}?mesh=comb&quality=cells:1`);
  const rates = [];
  // First the bytes come over the line and the code is cold. Then all bytes are here, and V8 has
  // optimised the code.
  for (let round = 0; round < 2; ++round) {
    await viewer.waitForState('held');
    await viewer.settle();
    await viewer.page.waitForTimeout(2000);
    const {seconds, used} = await refine(viewer);
    const {tetrahedra} = await viewer.counts();
    rates.push(
      `${Math.round(tetrahedra / seconds / 1000)},000 cells/s; ` +
        `${Math.round(tetrahedra / used / 1000)},000 a second of the worker's processor time`,
    );
    await viewer.settle();
    await viewer.page.evaluate(() => window.qtetViewer.setAttribute('quality', 'cells:1'));
  }
  row(
    'comb: refining in the page, its pictures included',
    '500,000 cells/s',
    rates.join('; once more, from the bytes that are here: '),
  );
  await browser.closePages();
}

async function measureCuts() {
  const viewer = await browser.open(
    `${server.url}?mesh=fin-500k&surface=off&clip=x:0.5&clip-mode=slice`,
  );
  await viewer.waitForState('complete');
  await viewer.settle();
  const median = async (name, texts) => {
    const costs = [];
    for (const text of texts) {
      await viewer.page.evaluate(
        ([attribute, value]) => window.qtetViewer.setAttribute(attribute, value),
        [name, text],
      );
      await viewer.settle();
      costs.push(await viewer.page.evaluate(() => window.qtetViewer.viewing.mesh.snapshot.costMs));
    }
    return costs.sort((a, b) => a - b)[costs.length >> 1];
  };
  const {tetrahedra} = await viewer.counts();
  const slice = await median('clip', ['x:0.45', 'x:0.5', 'x:0.55', 'x:0.6', 'x:0.65']);
  row(
    `fin of ${tetrahedra} cells: a slice in the worker`,
    '50 ms for 500,000',
    `${Math.round(slice)} ms`,
  );
  await viewer.page.evaluate(() => window.qtetViewer.removeAttribute('clip'));
  const surface = await median('iso', [
    'Density=1.2',
    'Density=1.4',
    'Density=1.6',
    'Density=1.8',
    'Density=2',
  ]);
  row(
    `fin of ${tetrahedra} cells: an isosurface in the worker`,
    '150 ms',
    `${Math.round(surface)} ms`,
  );
  await browser.closePages();
}

async function measureVolume() {
  for (const opacities of ['0,0.1,0.3,0.6', '0.9,0.9,0.9']) {
    const viewer = await browser.open(`${server.url}?mesh=comb&volume=${opacities}`);
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    await viewer.restVolume();
    const took = [],
      used = [];
    for (let round = 0; round < 3; ++round) {
      const before = graphicsSeconds();
      took.push(
        await viewer.page.evaluate(async () => {
          const start = performance.now();
          await window.qtetViewer.meshView.picture('#fff');
          return (performance.now() - start) / 1000;
        }),
      );
      used.push(graphicsSeconds() - before);
    }
    const median = (values) => values.sort((a, b) => a - b)[1].toFixed(1);
    row(
      `comb: the volume with opacities ${opacities}, all pixels of 1280 x 800 by software`,
      '',
      `${median(took)} s; ${median(used)} s of the graphics' processor time`,
    );
    await browser.closePages();
  }
}

async function measureLines() {
  const vtu = statSync(meshes['post-welded']).size;
  for (const megabits of [1, 10]) {
    const line = await PoorLine.open(server.port, {
      bytesPerSecond: (megabits * 1e6) / 8,
      delayMs: 20,
    });
    const viewer = await browser.open(`${line.url}?mesh=post-welded&quality=1%25`);
    await viewer.waitForState('held');
    const held = await viewer.page.evaluate(() => performance.now());
    await viewer.waitForPicture();
    const {events} = await viewer.seen();
    const seconds = (ms) => (ms / 1000).toFixed(1);
    row(
      `post-welded at ${megabits} Mbit/s, viewer included: first picture; 1 % of error; the ` +
        '.vtu alone',
      '',
      `${seconds(events.find(({type}) => type === 'load').at)} s; ${seconds(held)} s; ` +
        `${((vtu * 8) / megabits / 1e6).toFixed(1)} s`,
    );
    await browser.closePages();
    line.close();
  }
}

try {
  for (const measure of [
    measureLoading,
    measureInput,
    measureDecoding,
    measureCuts,
    measureVolume,
    measureLines,
  ])
    await measure();
} finally {
  await browser.close();
  server.kill();
  console.log(['| what | bar | measured |', '|---|---|---|', ...rows].join('\n'));
}
