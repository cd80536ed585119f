// The size of the original that the last level was reduced from, in a manifest.

import {expect, test} from 'vitest';
import {readManifest, type Manifest} from '../core/protocol/manifest';
import {fakeHead} from './fakes';

const kOriginalFollows = 32;
/** The last level has 5 cells and 4 vertices. */
const columns = (): Uint32Array => Uint32Array.from([5, 4, 3]);

function read(flags: number, counts: number[]): Manifest {
  const head = fakeHead({fields: ['p'], chunks: 1});
  const tableAt = 64 + new DataView(head.buffer).getUint32(24, true);
  head[tableAt - 1] = flags;
  const bytes = new Uint8Array(Float64Array.from(counts).buffer);
  const whole = new Uint8Array(head.length + bytes.length);
  whole.set(head.subarray(0, tableAt));
  whole.set(bytes, tableAt);
  whole.set(head.subarray(tableAt), tableAt + bytes.length);
  new DataView(whole.buffer).setUint32(24, tableAt - 64 + bytes.length, true);
  return readManifest(whole, columns);
}

test('theOriginalHasItsCounts', () => {
  expect(read(0, []).original).toBeUndefined();
  const original = {tetrahedra: 5e9, vertices: 9e8};
  expect(read(kOriginalFollows, [5e9, 9e8]).original).toEqual(original);
  expect(read(kOriginalFollows, [5, 4]).original).toEqual({tetrahedra: 5, vertices: 4});
});

test.each([
  [[4, 4], 'more cells or vertices'],
  [[5, 3], 'more cells or vertices'],
  [[5.5, 4], 'no whole number'],
  [[5, NaN], 'not finite'],
  [[-1, 4], 'no whole number'],
])('theCounts %s areRefused', (counts, message) => {
  expect(() => read(kOriginalFollows, counts)).toThrow(message);
});

test('aFlagThatIsNotKnownIsRefused', () => {
  expect(() => read(2 * kOriginalFollows, [5, 4])).toThrow('flags');
});
