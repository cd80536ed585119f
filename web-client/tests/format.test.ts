import {expect, test} from 'vitest';
import {formatBytes, formatCoordinate, formatCount, percentOf} from '../viewer/format';

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
  expect(formatCoordinate(1234567, 2e6)).toBe('1.23e+6');
  expect(formatCoordinate(-0.00012345, 0.001)).toBe('\u22121.23e\u22124');
});

test('coordinatesOfAMapKeepTheirDigits', () => {
  expect(formatCoordinate(4600123.46, 20)).toBe('4600123.46');
  expect(formatCoordinate(499999.5, 20)).toBe('499999.50');
  expect(formatCoordinate(4600123.46, 9000)).toBe('4600123');
  expect(formatCoordinate(4612345, 2e5)).toBe('4.6123e+6');
});
