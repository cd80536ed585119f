import {expect, test} from 'vitest';
import {kMaxPoints, parsePoints, pointsText} from '../viewer/settings/points';

test('pointsComeBackFromTheirText', () => {
  const points: [number, number, number][] = [
    [1, -2.5, 0.000125],
    [1e-7, 1 / 3, 4500123.4],
  ];
  const text = '1,-2.5,0.000125 1e-7,0.3333333333,4500123.4';
  expect(pointsText(points)).toBe(text);
  expect(parsePoints(text)).toEqual([points[0], [1e-7, 0.3333333333, 4500123.4]]);
  expect(pointsText([])).toBeNull();
  expect(parsePoints('')).toEqual([]);
});

test('whatIsNoPointIsRefused', () => {
  const hostile = ['1e999,0,0', 'NaN,0,0', '0,-Infinity,0', '1,,2', ',,'];
  for (const text of ['1,2', '1,2,3,4', 'a,b,c', '1,2,3 4', ...hostile])
    expect(parsePoints(text), text).toBeNull();
  const point = '1,2,3 ';
  expect(parsePoints(point.repeat(kMaxPoints))).toHaveLength(kMaxPoints);
  expect(parsePoints(point.repeat(kMaxPoints + 1))).toBeNull();
});
