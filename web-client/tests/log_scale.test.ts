import {expect, test} from 'vitest';
import {linearPart, placeOn, valueAt} from '../core/picture/log_scale';

const kSigned = {low: -10, high: 1000, logarithmic: true};

test('onlyLogarithmsFromBelowZeroHaveALinearPart', () => {
  expect(linearPart({low: -10, high: 1000, logarithmic: false})).toBe(0);
  expect(linearPart({low: 1, high: 1000, logarithmic: true})).toBe(0);
  expect(linearPart(kSigned)).toBe(1);
  expect(linearPart({low: -2000, high: -1, logarithmic: true})).toBe(2);
});

test('decadesAreEvenOnBothSidesAndTheSlopeIsContinuous', () => {
  const decade = placeOn(kSigned, 1000) - placeOn(kSigned, 100);
  expect(placeOn(kSigned, 10) - placeOn(kSigned, 1)).toBeCloseTo(decade);
  expect(placeOn(kSigned, -1) - placeOn(kSigned, -10)).toBeCloseTo(decade);
  expect(placeOn(kSigned, 1) - placeOn(kSigned, 0)).toBeCloseTo(decade / Math.LN10);
  const slope = (at: number): number => placeOn(kSigned, at + 1e-6) - placeOn(kSigned, at);
  expect(slope(1) / slope(1 - 1e-6)).toBeCloseTo(1, 5);
  expect([placeOn(kSigned, -10), placeOn(kSigned, 1000)]).toEqual([0, 1]);
});

test('placesAndValuesAreInverse', () => {
  for (const scale of [kSigned, {low: -2000, high: -1, logarithmic: true}])
    for (const place of [0, 0.1, 0.3, 0.5, 0.9, 1])
      expect(placeOn(scale, valueAt(scale, place))).toBeCloseTo(place);
});
