import {expect, test} from 'vitest';
import {
  keptText,
  kMaxLines,
  kMaxName,
  kMaxPoints,
  mayKeep,
  parseKept,
  plainName,
  type Kept,
} from '../viewer/settings/points';

const kept = (name: string, ...places: [number, number, number][]): Kept => ({name, places});

test('pointsComeBackFromTheirText', () => {
  const points = [kept('', [1, -2.5, 0.000125]), kept('', [1e-7, 1 / 3, 4500123.4])];
  const text = '1,-2.5,0.000125 1e-7,0.3333333333,4500123.4';
  expect(keptText(points)).toBe(text);
  expect(parseKept('points', text)).toEqual([points[0], kept('', [1e-7, 0.3333333333, 4500123.4])]);
  expect(keptText([])).toBeNull();
  expect(parseKept('points', '')).toEqual([]);
});

test('namesStandBeforePlaces', () => {
  const points = [kept('Tip', [1, 2, 3]), kept('', [4, 5, 6]), kept('Cp: max, upper', [7, 8, 9])];
  const text = 'Tip: 1,2,3; 4,5,6; Cp: max, upper: 7,8,9';
  expect(keptText(points)).toBe(text);
  expect(parseKept('points', text)).toEqual(points);
  expect(parseKept('points', '4,5,6 7,8,9;Tip:1,2,3;')).toEqual([
    kept('', [4, 5, 6]),
    kept('', [7, 8, 9]),
    kept('Tip', [1, 2, 3]),
  ]);
});

test('aLineHasTwoPlaces', () => {
  const lines = [kept('Wake', [1, 2, 3], [4, 5, 6]), kept('', [0, 0, 0], [0, 0, 1])];
  const text = 'Wake: 1,2,3 4,5,6; 0,0,0 0,0,1';
  expect(keptText(lines)).toBe(text);
  expect(parseKept('lines', text)).toEqual(lines);
  expect(parseKept('lines', keptText(lines.slice(1))!)).toEqual(lines.slice(1));
  for (const wrong of ['1,2,3', 'Wake: 1,2,3', '1,2,3 4,5,6 7,8,9', 'Tip: 1,2,3 4,5,6 1,1,1 2,2,2'])
    expect(parseKept('lines', wrong), wrong).toBeNull();
  const two = '0,0,0 1,1,1 ';
  expect(parseKept('lines', two.repeat(kMaxLines))).toHaveLength(kMaxLines);
  expect(parseKept('lines', two.repeat(kMaxLines + 1))).toBeNull();
});

test('whatIsNoPointIsRefused', () => {
  const hostile = ['1e999,0,0', 'NaN,0,0', '0,-Infinity,0', '1,,2', ',,', 'Tip:', 'Tip; 1,2,3'];
  const words = ['1,2', '1,2,3,4', 'a,b,c', '1,2,3 4', 'Tip: 1,2,3 4,5,6', 'Tip 1,2,3'];
  for (const text of [...words, ...hostile]) expect(parseKept('points', text), text).toBeNull();
  const point = '1,2,3 ';
  expect(parseKept('points', point.repeat(kMaxPoints))).toHaveLength(kMaxPoints);
  expect(parseKept('points', point.repeat(kMaxPoints + 1))).toBeNull();
});

test('aNameIsShortAndPlain', () => {
  const name = 'n'.repeat(kMaxName);
  expect(parseKept('points', `${name}: 1,2,3`)).toEqual([kept(name, [1, 2, 3])]);
  expect(parseKept('points', `${name}n: 1,2,3`)).toBeNull();
  // a character that turns the text round, a line's end, and one without a partner
  expect(plainName(' a\u202eb\u0000\n\tc; \ud800d ')).toBe('a b c d');
  const hostile = '<img src=x onerror=alert(1)>';
  expect(parseKept('points', `${hostile}: 1,2,3`)).toEqual([kept(hostile, [1, 2, 3])]);
});

test('aPlaceIsKeptOnce', () => {
  const all = [kept('Tip', [1, 2, 3])];
  expect(mayKeep('points', all, [[1, 2, 3]])).toBe(false);
  expect(mayKeep('points', all, [[1, 2, 4]])).toBe(true);
  const full = Array.from({length: kMaxPoints}, (_, i) => kept('', [i, 0, 0]));
  expect(mayKeep('points', full.slice(1), [[0, 1, 0]])).toBe(true);
  expect(mayKeep('points', full, [[0, 1, 0]])).toBe(false);
});
