// Measures a viewer's first picture over a slow line, as tests/bench/VIEWER.md says it: headless
// Chromium, software WebGL, an empty cache, everything on this machine.
//   node first_picture.mjs --bin DIR --viewer DIR --out DIR [--rate KBIT] [--trip MS] [--times N]
//     [LOG.qtet...]
// Without logs it takes the sample `fin`. There are three hosts. The first is qtet-server. The
// others have a published folder: one sends its compressed files, the other knows no coding, as
// nginx by default.

import {cpSync, mkdirSync, rmSync} from 'node:fs';
import {basename, join} from 'node:path';
import {parseArgs} from 'node:util';
import {Browser} from './browser.mjs';
import {makeLog} from './programs.mjs';
import {SlowLine} from './slow_line.mjs';
import {threeHosts} from './three_hosts.mjs';

const {values: options, positionals} = parseArgs({
  allowPositionals: true,
  options: {
    bin: {type: 'string'},
    viewer: {type: 'string'},
    out: {type: 'string'},
    rate: {type: 'string', default: '400'},
    trip: {type: 'string', default: '300'},
    times: {type: 'string', default: '3'},
  },
});
if (!options.bin || !options.viewer || !options.out) {
  console.error('Usage: node first_picture.mjs --bin DIR --viewer DIR --out DIR [LOG.qtet...]');
  process.exit(2);
}
mkdirSync(options.out, {recursive: true});
const folder = join(options.out, 'logs');
rmSync(folder, {recursive: true, force: true});
mkdirSync(folder, {recursive: true});
if (positionals.length === 0) makeLog(options.bin, 'fin', options.out);
for (const log of positionals) cpSync(log, join(folder, basename(log)));
const names = positionals.length === 0 ? ['fin'] : positionals.map((log) => basename(log, '.qtet'));

/** Runs before the page's scripts: the times of what can be seen, in ms after the navigation. */
function watch() {
  const seen = (window.qtetFirst = {});
  const look = () => {
    const poster = document.querySelector('img[slot=poster]');
    if (!('poster' in seen) && poster?.complete && poster.naturalWidth > 0)
      seen.poster = performance.now();
    if (!('base' in seen)) requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
  document.addEventListener('DOMContentLoaded', () => {
    const listen = () => {
      const viewer = document.querySelector('qtet-viewer');
      if (!viewer) return void setTimeout(listen, 5);
      viewer.addEventListener('load', () => {
        seen.base = performance.now();
        void window.qtetBase();
      });
    };
    listen();
  });
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const hosts = await threeHosts({
  ...options,
  logs: names.map((name) => join(folder, `${name}.qtet`)),
});

async function measure(port, path) {
  const line = await SlowLine.open(port, {
    bytesPerSecond: (Number(options.rate) * 1000) / 8,
    roundTripMs: Number(options.trip),
  });
  const browser = await Browser.launch(options.out);
  try {
    const page = await browser.blank();
    let bytes = 0;
    const warnings = [];
    page.on('console', (message) => {
      if (message.type() === 'warning' && /preload/.test(message.text()))
        warnings.push(message.text());
    });
    await page.exposeFunction('qtetBase', () => void (bytes = line.bytes));
    await page.addInitScript(watch);
    await page.goto(line.url + path, {waitUntil: 'commit'});
    await page.waitForFunction(() => window.qtetFirst.base, null, {timeout: 120000});
    await page.waitForTimeout(100);
    const times = await page.evaluate(() => ({
      text: performance.getEntriesByName('first-contentful-paint')[0]?.startTime,
      ...window.qtetFirst,
    }));
    await page.waitForTimeout(4000);
    return {...times, bytes, warnings: warnings.length};
  } finally {
    await browser.close();
    line.close();
  }
}

console.log('| mesh | host | text | poster | base | bytes before it |\n|---|---|---|---|---|---|');
for (const name of names)
  for (const {what, port} of hosts) {
    const runs = [];
    for (let i = 0; i < Number(options.times); ++i)
      runs.push(await measure(port, `?mesh=${encodeURIComponent(name)}`));
    const of = (key) => {
      const value = median(runs.map((run) => run[key]));
      return value === undefined ? '' : `${(value / 1000).toFixed(2)} s`;
    };
    const bytes = median(runs.map((run) => run.bytes));
    const cells = [
      name,
      what,
      of('text'),
      of('poster'),
      of('base'),
      `${(bytes / 1000).toFixed(1)} kB`,
    ];
    console.log(`| ${cells.join(' | ')} |`);
    if (runs.some(({warnings}) => warnings > 0)) console.log('(warnings about preloads)');
  }
for (const host of hosts) host.close();
