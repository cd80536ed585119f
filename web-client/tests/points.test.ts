import {expect, test} from 'vitest';
import {kMaxPoints, parsePoints, pointsText} from '../viewer/settings/points';

test('pointsComeBackFromTheirText', () => {
  const points: [number, number, number][] = [
    [1, -2.5, 0.000125],
    [1e-7, 3, 1234567],
  ];
  expect(pointsText(points)).toBe('1,-2.5,0.000125 1e-7,3,1234570');
  expect(parsePoints('1,-2.5,0.000125 1e-7,3,1234570')).toEqual([points[0], [1e-7, 3, 1234570]]);
  expect(pointsText([])).toBeNull();
  expect(parsePoints('')).toEqual([]);
});

test('whatIsNoPointIsRefused', () => {
  for (const text of ['1,2', '1,2,3,4', 'a,b,c', '1,2,3 4']) expect(parsePoints(text)).toBeNull();
  const point = '1,2,3 ';
  expect(parsePoints(point.repeat(kMaxPoints))).toHaveLength(kMaxPoints);
  expect(parsePoints(point.repeat(kMaxPoints + 1))).toBeNull();
});
