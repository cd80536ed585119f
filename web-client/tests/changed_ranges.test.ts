import {expect, test} from 'vitest';
import {copyChanged, kBlockFloats} from '../webgl/changed_ranges';

const ramp = (count: number): Float32Array => Float32Array.from({length: count}, (_, i) => i);

test('nothingChangedGivesNoRange', () => {
  expect(copyChanged(ramp(5000), ramp(5000))).toEqual([]);
  expect(copyChanged(ramp(5000), ramp(3000))).toEqual([]);
});

test('whatChangedIsCopiedAndNamedByBlocksThatJoin', () => {
  const to = ramp(10 * kBlockFloats);
  const from = ramp(9 * kBlockFloats + 10);
  for (const at of [0, 3 * kBlockFloats - 1, 3 * kBlockFloats, 9 * kBlockFloats + 9]) from[at] = -1;
  expect(copyChanged(to, from)).toEqual([
    {start: 0, count: kBlockFloats},
    {start: 2 * kBlockFloats, count: 2 * kBlockFloats},
    {start: 9 * kBlockFloats, count: 10},
  ]);
  expect(to.subarray(0, from.length)).toEqual(from);
  expect(to[from.length]).toBe(from.length);
});
