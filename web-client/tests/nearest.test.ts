import {expect, test} from 'vitest';
import {nearest} from '../viewer/settings/nearest';

const kWords = ['viridis', 'cividis', 'turbo'];

test.each([
  ['viridsi', 'viridis'], // two neighbours swapped
  ['Turbo', 'turbo'],
  ['trbo', 'turbo'],
  ['cividiss', 'cividis'],
  ['rainbow', null],
  ['', null],
])('nearestTo "%s" is %s', (text, word) => {
  expect(nearest(text, kWords)).toBe(word);
});

test('aThirdOfTheLettersMayBeWrongButNotMore', () => {
  expect(nearest('abcxyz', ['abcdef'])).toBe(null); // 3 of 6
  expect(nearest('abcdyz', ['abcdef'])).toBe('abcdef'); // 2 of 6
  expect(nearest('b', ['a'])).toBe('a'); // always one
});
