import {expect, test} from 'vitest';
import type {FieldInfo} from '../core/protocol/fields';
import {
  formatBytes,
  formatCoordinate,
  formatCount,
  formatTo,
  formatValue,
  formatWithin,
  percentOf,
  resolutionOf,
  roundTo,
} from '../viewer/page/format';

const plain = (text: string): string => text.replaceAll(/[\u00a0\u202f]/g, ' ');

test('countsAreGroupedByThousands', () => {
  expect(plain(formatCount(0))).toBe('0');
  expect(plain(formatCount(1234567))).toBe('1 234 567');
});

test('bytesHaveThreeDigitsAndNeverFour', () => {
  expect(
    [0, 999, 1000, 12345, 999499, 999500, 1.5e9].map((bytes) => plain(formatBytes(bytes))),
  ).toEqual(['0 B', '999 B', '1.00 kB', '12.3 kB', '999 kB', '1.00 MB', '1.50 GB']);
});

test('theErrorOfTheLastLevelIsRoundedUp', () => {
  const field = {name: 'T@0.5', instant: {name: 'T'}, unit: 'K'} as FieldInfo;
  const within = (error: number): string => plain(formatWithin(field, error));
  expect(within(0.0412)).toBe('T is within 0.042 K at the last level');
  expect(within(0.0996)).toBe('T is within 0.1 K at the last level');
  expect(within(250)).toBe('T is within 250 K at the last level');
  expect(within(0)).toBe('T is exact at the last level');
  expect(plain(formatWithin(field, 0.04, 3.41))).toBe(
    'T is at most 3.5 K off now, as sampled, and within 0.04 K at the last level',
  );
});

test('aHundredPercentMeansAllOfIt', () => {
  expect(percentOf(999999, 1000000)).toBe(99);
  expect(percentOf(1000000, 1000000)).toBe(100);
  expect(percentOf(0, 0)).toBe(0);
});

test('coordinatesAreAsFineAsTheirAxis', () => {
  expect(formatCoordinate(31.1284, 60)).toBe('31.13');
  expect(formatCoordinate(4.02e-5, 5)).toBe('0.000');
  expect(formatCoordinate(-0.5, 1)).toBe('\u22120.500');
  expect(formatCoordinate(-0.00001, 1)).toBe('0.000');
  expect(formatCoordinate(4512, 9000)).toBe('4512');
  expect(formatCoordinate(1234567, 2e6)).toBe('1234567');
  expect(formatCoordinate(-0.00012345, 0.001)).toBe('\u22120.000123');
  expect(formatCoordinate(-1.2345e-9, 1e-8)).toBe('\u22121.23e\u22129');
});

const field = (info: Partial<FieldInfo>): FieldInfo => ({
  name: 'p',
  components: 1,
  association: 'point',
  step: 1e-9,
  minimum: [0],
  range: [0, 1],
  ...info,
});

test('valuesShowWhatTheyHoldAndNoMore', () => {
  const pressure = resolutionOf(field({range: [101324.5, 101325.5]}));
  expect(formatTo(101325.0312, pressure)).toBe('101325.0312');
  expect(roundTo(101325.03125, pressure)).toBe(101325.0313);
  expect(formatTo(500123, 0.1)).toBe('500123.0');
  expect(formatTo(4649776, 1)).toBe('4649776');
  expect(formatTo(120, 1)).toBe('120');
  expect(formatTo(NaN, 1)).toBe('missing');
  expect(formatTo(-1e-7, 0.01)).toBe('0.00');
  expect(formatTo(6.02214e23, 1e19)).toBe('6.0221e+23');
  expect(formatTo(-1.5e-12, 1e-14)).toBe('\u22121.50e\u221212');
});

test('labelsAreWholeAndCoarseValuesHaveNoInventedDigits', () => {
  const label = resolutionOf(field({isWhole: true, association: 'cell', range: [0, 7], step: 1}));
  expect(formatTo(3, label)).toBe('3');
  expect(resolutionOf(field({range: [0, 10], step: 0.5}))).toBe(0.5);
  expect(resolutionOf(field({components: 3, range: [0, 200]}))).toBeCloseTo(0.02);
  expect(formatValue(1234.5678)).toBe('1234.6');
  expect(formatValue(0)).toBe('0');
});

test('coordinatesOfAMapKeepTheirDigits', () => {
  expect(formatCoordinate(4600123.46, 20)).toBe('4600123.46');
  expect(formatCoordinate(499999.5, 20)).toBe('499999.50');
  expect(formatCoordinate(4600123.46, 9000)).toBe('4600123');
  expect(formatCoordinate(4612345, 2e5)).toBe('4612345');
});
