import {expect, test} from 'vitest';
import {isEqual} from '../core/protocol/equal';

test.each([
  [{a: [1, {b: null}]}, {a: [1, {b: null}]}, true],
  [{a: 1}, {a: 1, b: undefined}, true],
  [[NaN, Infinity], [NaN, Infinity], true],
  [{a: 1}, {a: 1, b: 0}, false],
  [[1, 2], [1], false],
  [null, {}, false],
  ['1', 1, false],
])('valuesAreEqualIfTheyHoldTheSame', (a, b, equal) => {
  expect([isEqual(a, b), isEqual(b, a)]).toEqual([equal, equal]);
});
