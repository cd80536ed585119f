import {expect, test} from 'vitest';
import {errorOfLevel, kFull, limitReached, limitText, parseLimit} from '../core/protocol/limit';
import type {Spread} from '../core/protocol/manifest';
import {kNoStatistics} from '../core/decode/statistics';

test.each([
  ['full', kFull],
  ['', kFull],
  ['cells:20000', {kind: 'cells', value: 20000}],
  ['bytes:1e5', {kind: 'bytes', value: 1e5}],
  ['error:0.01', {kind: 'error', value: 0.01}],
  ['1%', {kind: 'error', value: 0.01}],
  ['error:0.5%', {kind: 'error', value: 0.005}],
  ['cells:0', null],
  ['many', null],
  ['12', null],
])('aLimit %s isRead', (text, limit) => {
  expect(parseLimit(text)).toEqual(limit);
  if (limit) expect(parseLimit(limitText(limit as never))).toEqual(limit);
});

test('aLimitIsReachedByItsOwnFigure', () => {
  const statistics = {...kNoStatistics, tetrahedra: 100, bytes: 5000};
  expect(limitReached({kind: 'cells', value: 100}, statistics, null)).toBe(true);
  expect(limitReached({kind: 'cells', value: 101}, statistics, null)).toBe(false);
  expect(limitReached({kind: 'bytes', value: 5000}, statistics, null)).toBe(true);
  expect(limitReached({kind: 'bytes', value: 5001}, statistics, null)).toBe(false);
  expect(limitReached({kind: 'error', value: 0.01}, statistics, 0.01)).toBe(true);
  expect(limitReached({kind: 'error', value: 0.01}, statistics, null)).toBe(false);
  expect(limitReached(kFull, statistics, 0)).toBe(false);
});

test('theErrorIsThatOfTheWorstFieldShownOrElseOfTheBoundary', () => {
  const spread = (mean: number): Spread => ({mean, max: 1});
  const level = {
    level: 0,
    tetrahedra: 1,
    vertices: 4,
    boundaryTriangles: 4,
    error: {
      toLevel: spread(0.5),
      toOriginal: spread(0.25),
      volumeLost: 0,
      volumeGained: 0,
      fields: [spread(0.1), spread(0.2)],
    },
  };
  const unknown = {level: 1, tetrahedra: 2, vertices: 5, boundaryTriangles: 6};
  const of = (at: number, fields: number[]): number | null =>
    errorOfLevel([level, unknown], at, fields);
  expect([of(0, []), of(0, [0]), of(0, [0, 1])]).toEqual([0.25, 0.1, 0.2]);
  expect(of(1, [0]), 'that of the last coarser level where it was measured').toBe(0.1);
  expect(errorOfLevel([unknown], 0, [0])).toBeNull();
});
