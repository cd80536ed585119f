// What tests/bench/VIEWER.md says of the viewer, measured: headless Chromium, software WebGL, everything on this machine.
// Usage: QTET_DATA=FOLDER node measure.mjs --bin DIR --viewer DIR --out DIR      FOLDER holds comb.vtu and post-welded.vtu; prints the table

import {execFileSync} from 'node:child_process';
import {existsSync, mkdirSync, readdirSync, readFileSync, statSync} from 'node:fs';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {Browser} from './browser.mjs';
import {PoorLine} from './poor_line.mjs';
import {Server} from './programs.mjs';

const {values: options} = parseArgs({options: {bin: {type: 'string'}, viewer: {type: 'string'}, out: {type: 'string'}}});
const data = process.env.QTET_DATA;
if (!options.bin || !options.viewer || !options.out || !data) {
  console.error('Usage: QTET_DATA=FOLDER node measure.mjs --bin DIR --viewer DIR --out DIR');
  process.exit(2);
}
const folder = join(options.out, 'logs');
mkdirSync(folder, {recursive: true});
const tool = (...words) => execFileSync(join(options.bin, 'qtet'), words, {stdio: 'pipe'});
const meshes = {comb: join(data, 'comb.vtu'), 'post-welded': join(data, 'post-welded.vtu'), 'fin-500k': join(options.out, 'fin-500k.vtu')};
if (!existsSync(meshes['fin-500k'])) tool('sample', 'fin', '--cells', '500000', '-o', meshes['fin-500k']);
for (const [name, mesh] of Object.entries(meshes)) if (!existsSync(join(folder, `${name}.qtet`))) tool('simplify', mesh, '-o', join(folder, `${name}.qtet`));

const rows = [];
const row = (what, bar, value) => rows.push(`| ${what} | ${bar} | ${value} |`);
const server = new Server(options.bin, folder, options.viewer);
await server.start();
const browser = await Browser.launch(options.out);

/** The renderers that this process has started: process id and resident megabytes. */
function renderers() {
  const processes = readdirSync('/proc').filter((name) => /^\d+$/.test(name)).flatMap((pid) => {
    try {
      const status = readFileSync(`/proc/${pid}/status`, 'utf8');
      return [{pid, parent: /PPid:\s+(\d+)/.exec(status)[1], resident: Number(/VmRSS:\s+(\d+)/.exec(status)?.[1] ?? 0) / 1024, words: readFileSync(`/proc/${pid}/cmdline`, 'utf8')}];
    } catch {
      return [];  // it has ended
    }
  });
  const parents = new Map(processes.map(({pid, parent}) => [pid, parent]));
  const isOurs = (pid) => pid === String(process.pid) || (parents.has(pid) && isOurs(parents.get(pid)));
  return processes.filter(({pid, words}) => words.includes('--type=renderer') && isOurs(pid));
}

const rendererMegabytes = () => Math.max(0, ...renderers().map(({resident}) => resident));

/** What the pages' workers have had of the processors: other programs on this machine do not count. */
function workerSeconds() {
  const kTicks = 100;  // a second: USER_HZ
  let ticks = 0;
  for (const {pid} of renderers()) {
    for (const thread of readdirSync(`/proc/${pid}/task`)) {
      const [, name, rest] = /\((.*)\) (.*)/.exec(readFileSync(`/proc/${pid}/task/${thread}/stat`, 'utf8'));
      if (name.startsWith('DedicatedWorker')) ticks += rest.split(' ').slice(11, 13).reduce((sum, text) => sum + Number(text), 0);
    }
  }
  return ticks / kTicks;
}

async function measureLoading() {
  const viewer = await browser.open(`${server.url}?mesh=post-welded`);
  await viewer.waitForState('complete');
  await viewer.settle();
  const {longTasks, events} = await viewer.seen();
  const first = events.find(({type}) => type === 'load');
  const tasks = longTasks.map(({ms}) => Math.round(ms));
  row('post-welded: tasks of the page above 50 ms, from opening to the whole mesh', 'none', tasks.length > 0 ? `${tasks.length}: ${tasks.join(', ')} ms` : 'none');
  row('post-welded: from opening to the whole mesh', '', `${((events.find(({type}) => type === 'complete')?.at ?? NaN) / 1000).toFixed(1)} s`);
  const share = (100 * first.bytes) / statSync(meshes['post-welded']).size;
  row("post-welded: bytes of the first picture, of the .vtu's", '2 %', `${share.toFixed(1)} %`);
  const {tetrahedra} = await viewer.counts();
  const large = rendererMegabytes();
  await browser.closePages();
  const small = await browser.open(`${server.url}?mesh=comb&quality=cells:1`);
  await small.waitForState('held');
  await small.settle();
  row('post-welded: memory of the page a cell, above that of a page with a coarse mesh', '120 B', `${Math.round(((large - rendererMegabytes()) * 2 ** 20) / tetrahedra)} B`);
  await browser.closePages();
}

async function measureDecoding() {
  const viewer = await browser.open(`${server.url}?mesh=comb&quality=cells:1`);
  await viewer.waitForState('held');
  await viewer.page.waitForTimeout(2000);  // what the window holds arrives and waits
  const before = workerSeconds();
  const seconds = await viewer.page.evaluate(() => new Promise((resolve) => {
    const start = performance.now();
    window.qtetViewer.setAttribute('quality', 'full');
    const timer = setInterval(() => {
      if (window.qtetViewer.state !== 'complete') return;
      clearInterval(timer);
      resolve((performance.now() - start) / 1000);
    }, 2);
  }));
  const {tetrahedra} = await viewer.counts();
  const used = workerSeconds() - before;
  row('comb: refining in the page, its pictures included', '500,000 cells/s', `${Math.round(tetrahedra / seconds / 1000)},000 cells/s; ${Math.round(tetrahedra / used / 1000)},000 a second of the worker's processor time`);
  await browser.closePages();
}

async function measureCuts() {
  const viewer = await browser.open(`${server.url}?mesh=fin-500k&surface=off&clip=x:0.5&clip-mode=slice`);
  await viewer.waitForState('complete');
  await viewer.settle();
  const median = async (name, texts) => {
    const costs = [];
    for (const text of texts) {
      await viewer.page.evaluate(([attribute, value]) => window.qtetViewer.setAttribute(attribute, value), [name, text]);
      await viewer.settle();
      costs.push(await viewer.page.evaluate(() => window.qtetViewer.snapshot.costMs));
    }
    return costs.sort((a, b) => a - b)[costs.length >> 1];
  };
  const {tetrahedra} = await viewer.counts();
  const slice = await median('clip', ['x:0.45', 'x:0.5', 'x:0.55', 'x:0.6', 'x:0.65']);
  row(`fin of ${tetrahedra} cells: a slice in the worker`, '50 ms for 500,000', `${Math.round(slice)} ms`);
  await viewer.page.evaluate(() => window.qtetViewer.removeAttribute('clip'));
  const surface = await median('iso', ['Density=1.2', 'Density=1.4', 'Density=1.6', 'Density=1.8', 'Density=2']);
  row(`fin of ${tetrahedra} cells: an isosurface in the worker`, '150 ms', `${Math.round(surface)} ms`);
  await browser.closePages();
}

async function measureVolume() {
  const viewer = await browser.open(`${server.url}?mesh=comb&volume=0,0.1,0.3,0.6`);
  await viewer.waitForState('complete');
  await viewer.page.waitForTimeout(4000);
  const {order, whole} = await viewer.page.evaluate(async () => {
    const {client, meshView} = window.qtetViewer;
    const start = performance.now();
    await client.order([1e5, 2e5, 3e4]);
    const sorted = performance.now();
    void meshView.picture('#fff');
    meshView.canvas.getContext('webgl2').readPixels(0, 0, 1, 1, 6408, 5121, new Uint8Array(4));
    return {order: sorted - start, whole: performance.now() - sorted};
  });
  row('comb: the volume, sorted in the worker', '', `${Math.round(order)} ms`);
  row('comb: the volume, drawn with all pixels of 1280 x 800 by software', '', `${(whole / 1000).toFixed(1)} s`);
  await browser.closePages();
}

async function measureLines() {
  const vtu = statSync(meshes['post-welded']).size;
  for (const megabits of [1, 10]) {
    const line = await PoorLine.open(server.port, {bytesPerSecond: (megabits * 1e6) / 8, delayMs: 20});
    const viewer = await browser.open(`${line.url}?mesh=post-welded&quality=1%25`);
    await viewer.waitForState('held');
    const held = await viewer.page.evaluate(() => performance.now());
    await viewer.waitForPicture();
    const {events} = await viewer.seen();
    const seconds = (ms) => (ms / 1000).toFixed(1);
    row(`post-welded at ${megabits} Mbit/s, viewer included: first picture; 1 % of error; the .vtu alone`, '',
      `${seconds(events.find(({type}) => type === 'load').at)} s; ${seconds(held)} s; ${((vtu * 8) / megabits / 1e6).toFixed(1)} s`);
    await browser.closePages();
    line.close();
  }
}

try {
  for (const measure of [measureLoading, measureDecoding, measureCuts, measureVolume, measureLines]) await measure();
} finally {
  await browser.close();
  server.kill();
  console.log(['| what | bar | measured |', '|---|---|---|', ...rows].join('\n'));
}
