import {expect, test} from 'vitest';
import {isOutside, Lens} from '../webgl/lens';
import {product} from '../webgl/matrix';

/** A lattice of 100 steps is half as long as the scene's unit. */
const kPlaced = [0.005, 0, 0, 0, 0, 0.005, 0, 0, 0, 0, 0.005, 0, 0, 0, 0, 1];
const kBounds = [0, 0, 0, 100, 100, 100];

function isOutsideAt(eye: [number, number, number], bounds = kBounds): boolean {
  const lens = new Lens(40);
  lens.eye = eye;
  lens.lookAt([0.25, 0.25, 0.25]);
  return isOutside(bounds, product(lens.toEye, kPlaced));
}

test('anEyeIsOutsideBesideAnyFace', () => {
  for (const axis of [0, 1, 2])
    for (const at of [-0.1, 0.6]) {
      const eye: [number, number, number] = [0.2, 0.2, 0.2];
      eye[axis] = at;
      expect(isOutsideAt(eye)).toBe(true);
    }
});

test('anEyeInABoxOrNearItsFaceIsNotOutside', () => {
  expect(isOutsideAt([0.2, 0.2, 0.3])).toBe(false);
  expect(isOutsideAt([0.2, 0.2, 0.508])).toBe(false);
  expect(isOutsideAt([0.2, 0.2, 0.51])).toBe(true);
});

test('withoutBoundsNothingIsOutside', () => {
  expect(isOutsideAt([5, 5, 5], [])).toBe(false);
});
