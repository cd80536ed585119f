import {expect, test} from 'vitest';
import {largestRoundingError, widthOfValues, type FieldInfo} from '../core/protocol/fields';

// the same numbers as in tests/proto/rounding_error_test.cpp
const field: FieldInfo = {
  name: 'T',
  components: 1,
  association: 'point',
  type: 1,
  bits: 4,
  step: 2,
  minimum: [-7],
  range: [-7, 23],
};

test('theLargestRoundingErrorIsHalfAStepAndTheRoundingOfTheType', () => {
  expect(largestRoundingError(field)).toBe(1 + 23 * 2 ** -49);
  expect(largestRoundingError({...field, type: 0})).toBe(1 + (23 * 2 ** -24 + 23 * 2 ** -49));
  expect(largestRoundingError({...field, type: 5, isWhole: true})).toBe(1.5 + 23 * 2 ** -49);
});

test('integersAndConstantsAreExact', () => {
  expect(largestRoundingError({...field, step: 1, isWhole: true})).toBe(0);
  expect(largestRoundingError({...field, range: [-7, -7]})).toBe(0);
  expect(largestRoundingError({...field, range: [0, 0]})).toBeGreaterThan(1);
});

test('knownErrorsArePartsOfTheWidthOfTheValues', () => {
  expect(widthOfValues(field)).toBe(30);
  const magnitudes = {
    ...field,
    components: 3,
    minimum: [-7, 0, 0],
    range: [0, 9] as [number, number],
  };
  expect(widthOfValues(magnitudes)).toBe(Math.sqrt(3) * 30);
});
