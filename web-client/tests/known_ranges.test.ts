import {expect, test} from 'vitest';
import {KnownRanges} from '../viewer/page/known_ranges';

const of = (low: number, high: number): {extent: [number, number]; middle: [number, number]} => ({
  extent: [low, high],
  middle: [low + 1, high - 1],
});

test('aFieldsRangeIsThatOfAllSegmentsThatWereShown', () => {
  const ranges = new KnownRanges();
  expect(ranges.join('T', 0, of(0, 10))).toEqual(of(0, 10));
  expect(ranges.join('T', 1, of(5, 20))).toEqual(of(0, 20));
  expect(ranges.join('S', 1, of(5, 7))).toEqual(of(5, 7));
});

test('aSegmentsLaterRangeReplacesItsEarlierOne', () => {
  const ranges = new KnownRanges();
  ranges.join('T', 0, of(-50, 50));
  ranges.join('T', 1, of(0, 10));
  expect(ranges.join('T', 0, of(2, 8))).toEqual(of(0, 10));
});
