// The golden files, judged by the WebAssembly codec as tests/codec judges them natively. Needs the
// built codec, which QTET_WASM names (ctest sets it). Without it these tests are skipped.

import {createHash} from 'node:crypto';
import {readdirSync, readFileSync} from 'node:fs';
import {describe, expect, test} from 'vitest';
import {WasmCodec} from '../core/decode/codec';
import {kDraco} from '../core/decode/draco';
import {errorCode} from '../core/protocol/errors';
import {kTestWasm, takeWholeLog} from './whole_log';

const kGolden = new URL('../../tests/golden/', import.meta.url);
/** These are wrong only in the file's length, which a stream of blocks does not have. */
const kLengthOnly = ['truncated.last-byte.qtet', 'bad-value.one-byte-too-many.qtet'];

/** Digests of the finest mesh (codec/FORMAT.md, "Digests"). */
interface Digests {
  mesh: string;
  fields: string[];
}

/** Decodes a whole log block by block, as the worker does, or throws. */
async function decode(log: Uint8Array): Promise<Digests> {
  const assembler = await takeWholeLog(log, kDraco);
  const {codec} = assembler;
  const fields = assembler.manifest!.fields.map(({components}, i) =>
    createHash('sha256').update(codec.field(i, components)!).digest('hex'),
  );
  return {mesh: codec.digest(), fields};
}

/** "DIGEST  NAME" a line, as sha256sum writes. */
const digestsIn = (file: string): Map<string, string> =>
  new Map(
    readFileSync(new URL(file, kGolden), 'utf8')
      .trim()
      .split('\n')
      .map((line) => line.split(/\s+/).reverse() as [string, string]),
  );

const filesIn = (folder: string): string[] => readdirSync(new URL(folder, kGolden)).sort();
const read = (path: string): Uint8Array => new Uint8Array(readFileSync(new URL(path, kGolden)));

describe.skipIf(kTestWasm === '')('golden files', () => {
  const digests = digestsIn('digests.txt'),
    fieldDigests = digestsIn('field-digests.txt');

  test.each(filesIn('valid'))('valid %s decodesToItsDigests', async (name) => {
    const decoded = await decode(read(`valid/${name}`));
    expect(decoded.mesh).toBe(digests.get(name));
    decoded.fields.forEach((digest, i) =>
      expect(digest, `field ${i}`).toBe(fieldDigests.get(`${name}/${i}`)),
    );
  });

  test.each(filesIn('must-fail').filter((name) => !kLengthOnly.includes(name)))(
    'broken %s failsWithTheCodeInItsName',
    async (name) => {
      const code = await decode(read(`must-fail/${name}`)).then(() => 'accepted', errorCode);
      expect(code).toBe(name.slice(0, name.indexOf('.')));
    },
  );
});

describe.skipIf(kTestWasm === '')('the module of the base mesh', () => {
  const module = WebAssembly.compile(readFileSync(kTestWasm.replace(/codec(?=\.wasm$)/, 'base')));
  const whole = WebAssembly.compile(readFileSync(kTestWasm));

  test.each(filesIn('valid'))('decodes that of %s and gives way to the codec', async (name) => {
    const log = read(`valid/${name}`);
    const assembler = await takeWholeLog(log, kDraco, await module);
    const {codec} = assembler;
    expect([codec.isWhole, codec.chunksApplied]).toEqual([false, 1]);
    const {fields} = assembler.manifest!;
    const mesh = (): unknown => [
      [codec.points(), codec.tetrahedra(), codec.boundary()].map((its) => its.slice()),
      fields.map(({components}, field) => codec.field(field, components)?.slice()),
    ];
    const base = mesh();
    expect(codec).toBeInstanceOf(WasmCodec);
    if (codec instanceof WasmCodec) codec.become(await whole);
    const all = fields.map((_, field) => field);
    assembler.renew(all);
    expect([codec.isWhole, codec.chunksApplied]).toEqual([true, 1]);
    expect(mesh()).toEqual(base);
    while (assembler.step(all, true)) continue;
    expect(codec.digest()).toBe(digestsIn('digests.txt').get(name));
  });
});
