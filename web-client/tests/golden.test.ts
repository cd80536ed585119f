// The golden files, judged by the WebAssembly codec as tests/codec/golden_test.cpp judges them natively. Needs the built codec:
// QTET_WASM names it (ctest does); without it these tests are skipped.

import {createHash} from 'node:crypto';
import {readdirSync, readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {describe, expect, test} from 'vitest';
import {Assembler} from '../core/assembler';
import {WasmCodec} from '../core/codec';
import {DracoValueDecoder} from '../core/draco';
import {errorCode, QtetError} from '../core/errors';
import {kFirstFieldPart, kHeadPart} from '../core/protocol';

const kGolden = new URL('../../tests/golden/', import.meta.url);
const wasm = process.env.QTET_WASM ?? '';
const kHeaderBytes = 64;
/** These are wrong by the file's length alone, which a stream of blocks does not have. */
const kLengthOnly = ['truncated.last-byte.qtet', 'bad-value.one-byte-too-many.qtet'];

const compile = (path: string): Promise<WebAssembly.Module> => WebAssembly.compile(readFileSync(path));

/** Digests of the finest mesh (codec/FORMAT.md, "Digests"). */
interface Digests {
  mesh: string;
  fields: string[];
}

/** Decodes a whole log block by block, as the worker does, or throws. */
async function decode(log: Uint8Array): Promise<Digests> {
  const codec = await WasmCodec.create(await compile(wasm));
  const draco = await DracoValueDecoder.create(await compile(createRequire(import.meta.url).resolve('draco3d/draco_decoder.wasm')));
  const assembler = new Assembler(codec, draco);
  const header = new DataView(log.buffer, log.byteOffset, log.byteLength);
  const headBytes = log.length < kHeaderBytes ? log.length : kHeaderBytes + header.getUint32(24, true) + header.getUint32(28, true);
  assembler.take({stream: 1, chunk: 0, firstPart: kHeadPart, parts: 0, payload: log.subarray(0, headBytes)});
  const parts = kFirstFieldPart + assembler.manifest!.fields.length;
  for (let chunk = 0, at = headBytes; chunk < codec.chunkCount; ++chunk) {
    const sizes = Array.from({length: parts}, (_, part) => codec.blockSize(chunk, part));
    const end = at + sizes.reduce((sum, size) => sum + size, 0);
    if (end > log.length) throw new QtetError('truncated', `chunk ${chunk} ends at ${end} of ${log.length} bytes`);
    assembler.take({stream: 1, chunk, firstPart: 0, parts, payload: log.subarray(at, end)});
    at = end;
  }
  const fields = assembler.manifest!.fields.map(({components}, i) =>
    createHash('sha256').update(codec.field(i, components)!).digest('hex'));
  return {mesh: codec.digest(), fields};
}

/** "DIGEST  NAME" a line, as sha256sum writes. */
const digestsIn = (file: string): Map<string, string> => new Map(readFileSync(new URL(file, kGolden), 'utf8').trim().split('\n')
  .map((line) => line.split(/\s+/).reverse() as [string, string]));

const filesIn = (folder: string): string[] => readdirSync(new URL(folder, kGolden)).sort();
const read = (path: string): Uint8Array => new Uint8Array(readFileSync(new URL(path, kGolden)));

describe.skipIf(wasm === '')('golden files', () => {
  const digests = digestsIn('digests.txt'), fieldDigests = digestsIn('field-digests.txt');

  test.each(filesIn('valid'))('valid %s decodesToItsDigests', async (name) => {
    const decoded = await decode(read(`valid/${name}`));
    expect(decoded.mesh).toBe(digests.get(name));
    decoded.fields.forEach((digest, i) => expect(digest, `field ${i}`).toBe(fieldDigests.get(`${name}/${i}`)));
  });

  test.each(filesIn('must-fail').filter((name) => !kLengthOnly.includes(name)))('broken %s failsWithTheCodeInItsName', async (name) => {
    const code = await decode(read(`must-fail/${name}`)).then(() => 'accepted', errorCode);
    expect(code).toBe(name.slice(0, name.indexOf('.')));
  });
});
