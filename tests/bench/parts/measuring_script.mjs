// Measures decoding, as a script for a page or for node. It is made of the sources of a
// web-client/core, so that two versions can be compared.
import {createRequire} from 'node:module';

const require = createRequire(new URL('../../../web-client/package.json', import.meta.url));

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
    const manifest = readManifest(head, (...words) => codec.levelColumns(...words));
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

/**
 * A script that sets globalThis.measure(module, log, runs), both in base64: the least milliseconds
 * of so many runs. `core` is the path of a web-client/core.
 */
export async function measuringScript(core) {
  const {build} = require('esbuild');
  const bundled = await build({
    stdin: {contents: page, resolveDir: core, loader: 'ts'},
    bundle: true,
    write: false,
    format: 'iife',
    target: 'es2022',
  });
  return bundled.outputFiles[0].text;
}
