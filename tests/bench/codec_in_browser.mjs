// Decoding in Chromium, one thread: value blocks of both coders, and everything from bytes to mesh
// and fields, of one mesh's logs.
//   codec_in_browser.mjs --wasm build/release/web-client/qtet-codec.wasm LOG.qtet...
// Network and drawing are left out. Every figure is the best of kRuns, since whatever disturbs only
// adds.
import {createRequire} from 'node:module';
import {readFileSync} from 'node:fs';
import {basename} from 'node:path';
import {fileURLToPath} from 'node:url';

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

const page = `
import {headBytesOf} from './transport/block_source';
import {WasmCodec, kDracoCodec} from './decode/codec';
import {kDraco} from './decode/draco';
import {readManifest} from './protocol/manifest';
import {readValueBlock} from './decode/value_block';
const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));

globalThis.measure = async (module, log, runs) => {
  const file = bytesOf(log);
  const compiled = await WebAssembly.compile(bytesOf(module));
  let best = {values: Infinity, all: Infinity};
  for (let run = 0; run < runs; ++run) {
    const codec = new WasmCodec(compiled);
    const raw = codec.wasm;
    const head = file.subarray(0, headBytesOf(file));
    codec.open(head);
    const chunks = codec.chunkCount;
    const manifest = readManifest(head, (bytes, columns) => codec.levelColumns(bytes, columns));
    const components = [0, 3, ...manifest.fields.map((field) => field.components)];
    const fields = components.length - 2;
    let values = 0, integers = 0, valueBytes = 0;
    const begin = performance.now();
    for (let chunk = 0; chunk < chunks; ++chunk) {
      const block = (part) => {
        const offset = codec.blockOffset(chunk, part);
        return file.subarray(offset, offset + codec.blockSize(chunk, part));
      };
      const valuesOf = (part) => {
        const bytes = block(part);
        integers += codec.blockValues(chunk, part) * components[part];
        valueBytes += bytes.length;
        const from = performance.now();
        const at = {chunk, part, components: components[part]};
        const out = readValueBlock(codec, kDraco, at, bytes);
        if (codec.blockCodec(chunk, part) === kDracoCodec) values += performance.now() - from;
        return out;
      };
      for (let part = 0; part < components.length; ++part) {
        codec.checkBlock(chunk, part, block(part));
      }
      codec.apply(chunk, block(0), valuesOf(1));
      for (let f = 0; f < fields; ++f) codec.applyField(f, chunk, valuesOf(2 + f));
    }
    const all = performance.now() - begin;
    best = {
      values: Math.min(best.values, values),
      all: Math.min(best.all, all),
      cells: codec.tetrahedronCount,
      integers,
      valueBytes,
      memory: raw.memory.buffer.byteLength,
      digest: codec.digest(),
    };
  }
  return best;
};
`;

const {build} = require('esbuild');
const bundled = await build({
  stdin: {contents: page, resolveDir: fileURLToPath(core), loader: 'ts'},
  bundle: true,
  write: false,
  format: 'iife',
  target: 'es2022',
});
const launch = [];
if (process.getuid?.() === 0) launch.push('--no-sandbox');
const browser = await chromium.launch({
  executablePath: process.env.QTET_CHROMIUM ?? '/usr/bin/chromium',
  headless: true,
  args: launch,
});
const tab = await browser.newPage();
await tab.addScriptTag({content: bundled.outputFiles[0].text});
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
