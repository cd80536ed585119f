// The golden files, judged by the WebAssembly codec as tests/codec/golden_test.cpp judges them natively. Needs the built codec:
// QTET_WASM names it (ctest does); without it these tests are skipped.

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

/** Decodes a whole log block by block, as the worker does; gives the mesh digest or throws. */
async function decode(log: Uint8Array): Promise<string> {
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
  return codec.digest();
}

const filesIn = (folder: string): string[] => readdirSync(new URL(folder, kGolden)).sort();
const read = (path: string): Uint8Array => new Uint8Array(readFileSync(new URL(path, kGolden)));

describe.skipIf(wasm === '')('golden files', () => {
  const digests = new Map(readFileSync(new URL('digests.txt', kGolden), 'utf8').trim().split('\n')
    .map((line) => line.split(/\s+/).reverse() as [string, string]));

  test.each(filesIn('valid'))('valid %s decodesToItsDigest', async (name) => {
    expect(await decode(read(`valid/${name}`))).toBe(digests.get(name));
  });

  test.each(filesIn('must-fail').filter((name) => !kLengthOnly.includes(name)))('broken %s failsWithTheCodeInItsName', async (name) => {
    const code = await decode(read(`must-fail/${name}`)).then(() => 'accepted', errorCode);
    expect(code).toBe(name.slice(0, name.indexOf('.')));
  });
});
