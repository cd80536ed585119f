import {expect, test} from 'vitest';
import {FieldScale, kMagnitude} from '../core/picture/field_scale';
import {countsOf, histogramOf, kBars, type Axis, type Histogram} from '../core/picture/histogram';
import {valueAt} from '../core/picture/log_scale';
import type {FieldInfo} from '../core/protocol/fields';
import {
  axisOf,
  barsPath,
  heightsOf,
  kMinApart,
  movedRange,
  nearestEnd,
  shareOf,
} from '../viewer/panels/histogram_axis';
import type {ShownRange} from '../viewer/settings/settings';

const kLinear: Axis = {low: 0, high: 10, logarithmic: false};
const kDecades: Axis = {low: 1, high: 1e4, logarithmic: true};
const kSigned: Axis = {low: -10, high: 1000, logarithmic: true};
const filled = (counts: number[]): [number, number][] =>
  [...counts.entries()].filter(([, count]) => count > 0);
const range = (low: number, high: number, logarithmic = false): ShownRange => ({
  low,
  high,
  logarithmic,
  hides: 'none',
  hasMissing: false,
});

test('bothEndsOfTheAxisCountAndValuesBesideItDoNot', () => {
  const counts = countsOf(Float64Array.of(-0.001, 0, 0, 5, 10, 10.001), kLinear);
  expect(filled(counts)).toEqual([
    [0, 2],
    [kBars / 2, 1],
    [kBars - 1, 1],
  ]);
});

test('aLogarithmicAxisCountsDecadesAndNothingAtOrBelowZero', () => {
  const counts = countsOf(Float64Array.of(-1, 0, 1, 100, 1e4), kDecades);
  expect(filled(counts)).toEqual([
    [0, 1],
    [kBars / 2, 1],
    [kBars - 1, 1],
  ]);
});

test('aConstantFieldIsOneBarInTheMiddle', () => {
  const axis: Axis = {low: 42.5, high: 42.5, logarithmic: false};
  expect(filled(countsOf(Float64Array.of(42.5, 42.5), axis))).toEqual([[kBars / 2, 2]]);
  expect(shareOf(axis, 42.5)).toBe(0.5);
  expect(barsPath(countsOf(Float64Array.of(42.5), axis))).toBe('M28 1V0.000h.86V1z');
});

/** A field of 101 vertices with the values 0 to 100; those in `missing` have none. */
function counted(missing: number[] = []): Histogram {
  const info: FieldInfo = {
    name: 'p',
    association: 'point',
    components: 1,
    range: [0, 100],
    step: 1,
    minimum: [0],
    isWhole: false,
  } as unknown as FieldInfo;
  const values = Int32Array.from({length: 101}, (_, i) => (missing.includes(i) ? -2147483648 : i));
  const firsts = [...new Array(98).keys()];
  const cells = Uint32Array.from(firsts.flatMap((i) => [i, i + 1, i + 2, i + 3]));
  const scalar = {field: 0, component: kMagnitude};
  const axis = {...kLinear, high: 100};
  return histogramOf(new FieldScale(values, info), cells, info, scalar, axis);
}

test('eachVertexCountsOnceAndTheMiddleHolds98Percent', () => {
  const {total, extent, middle, counts} = counted();
  expect([total, extent, middle]).toEqual([101, [0, 100], [1, 99]]);
  expect(counts.reduce((sum, count) => sum + count, 0)).toBe(101);
});

test('missingValuesCountNowhere', () => {
  const {total, extent, counts} = counted([0, 50, 100]);
  expect([total, extent]).toEqual([98, [1, 99]]);
  expect(counts.reduce((sum, count) => sum + count, 0)).toBe(98);
  const none = counted([...new Array(101).keys()]);
  expect([none.total, none.extent, none.middle]).toEqual([0, null, null]);
  expect(barsPath(none.counts)).toBe('');
});

test('theAxisHoldsTheValuesAndTheRange', () => {
  expect(axisOf(range(2, 12), [0, 10])).toEqual({low: 0, high: 12, logarithmic: false});
  expect(axisOf(range(-1, 5), [0, 10])).toEqual({low: -1, high: 10, logarithmic: false});
  // a logarithm has no place for values at or below 0
  expect(axisOf(range(0.01, 100, true), [0, 100])).toEqual({...kDecades, low: 0.01, high: 100});
});

test('placesAndValuesAreInverse', () => {
  for (const axis of [kLinear, kDecades, kSigned])
    for (const share of [0, 0.25, 0.5, 1])
      expect(shareOf(axis, valueAt(axis, share))).toBeCloseTo(share);
  expect(shareOf(kLinear, -5)).toBe(0);
  expect(shareOf(kLinear, 15)).toBe(1);
  expect(shareOf(kDecades, 0)).toBe(0);
});

test('aHandleStopsAtTheAxisEndsAndBeforeTheOtherHandle', () => {
  expect(movedRange(kLinear, [2, 8], 0, 0.3)).toEqual([3, 8]);
  expect(movedRange(kLinear, [2, 8], 0, -1)).toEqual([0, 8]);
  expect(movedRange(kLinear, [2, 8], 1, 2)).toEqual([2, 10]);
  expect(movedRange(kLinear, [2, 8], 0, 0.9)[0]).toBeCloseTo(8 - 10 * kMinApart);
  expect(movedRange(kLinear, [2, 8], 1, 0.1)[1]).toBeCloseTo(2 + 10 * kMinApart);
  expect(movedRange(kDecades, [1, 1e4], 0, 0.25)[0]).toBeCloseTo(10);
});

test('aPointerTakesTheNearerHandle', () => {
  expect(nearestEnd(kLinear, [2, 8], 0.49)).toBe(0);
  expect(nearestEnd(kLinear, [2, 8], 0.51)).toBe(1);
  expect(nearestEnd(kLinear, [5, 5], 0.6)).toBe(1);
});

test('barsAreAsHighAsSquareRoots', () => {
  expect(heightsOf([100, 25, 0, 1])).toEqual([1, 0.5, 0, 0.1]);
  // one that holds anything is seen
  expect(heightsOf([1e6, 1])).toEqual([1, 0.03]);
  expect(heightsOf([0, 0])).toEqual([0, 0]);
});
