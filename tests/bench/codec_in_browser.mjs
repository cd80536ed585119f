// Decoding in Chromium, one thread: value blocks of both coders, and everything from bytes to mesh
// and fields, of one mesh's logs.
//   codec_in_browser.mjs --wasm build/release/web-client/qtet-codec.wasm LOG.qtet...
// Network and drawing are left out. Every figure is the best of kRuns, since whatever disturbs only
// adds.
import {createRequire} from 'node:module';
import {readFileSync} from 'node:fs';
import {basename} from 'node:path';
import {fileURLToPath} from 'node:url';
import {measuringScript} from './parts/measuring_script.mjs';

const kRuns = 7;
const core = new URL('../../web-client/core/', import.meta.url);
const require = createRequire(new URL('../package.json', core));
const {chromium} = require('playwright-core');

const args = process.argv.slice(2);
const wasm = args[args.indexOf('--wasm') + 1];
const logs = args.filter((arg) => arg.endsWith('.qtet'));
if (!args.includes('--wasm') || logs.length === 0) {
  console.error('usage: codec_in_browser.mjs --wasm MODULE.wasm LOG.qtet...');
  process.exit(2);
}

const launch = [];
if (process.getuid?.() === 0) launch.push('--no-sandbox');
const browser = await chromium.launch({
  executablePath: process.env.QTET_CHROMIUM ?? '/usr/bin/chromium',
  headless: true,
  args: launch,
});
const tab = await browser.newPage();
await tab.addScriptTag({content: await measuringScript(fileURLToPath(core))});
console.log(
  '| log | value blocks | Draco alone | everything | tetrahedra a second | memory of the module |',
);
console.log('|---|---|---|---|---|---|');
for (const log of logs) {
  const m = await tab.evaluate(
    ([module, file, runs]) => globalThis.measure(module, file, runs),
    [readFileSync(wasm).toString('base64'), readFileSync(log).toString('base64'), kRuns],
  );
  const rate =
    m.values > 0
      ? `${m.values.toFixed(1)} ms, ${((m.integers * 4) / m.values / 1e3).toFixed(0)} MB/s`
      : '-';
  console.log(
    `| ${basename(log)} | ${(m.valueBytes / 1e3).toFixed(0)} kB, ${m.integers} integers | ${rate}`,
    `| ${m.all.toFixed(0)} ms | ${(m.cells / m.all).toFixed(0)} k`,
    `| ${(m.memory / m.cells).toFixed(0)} B a tetrahedron |`,
  );
}
await browser.close();
