import {expect, test} from 'vitest';
import {facePlaces, nearestFace} from '../viewer/panels/orientation_cube';
import {Lens, type Axes} from '../webgl/lens';

const kFromAbove: Axes = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];

function fromThere(): Axes {
  const lens = new Lens(30);
  lens.eye = [0.5, -0.7, 0.4];
  lens.lookAt([0, 0, 0]);
  return lens.axes;
}

test('aCameraFromAboveSeesTheTopUpright', () => {
  const places = facePlaces(kFromAbove);
  const seen = places.filter(({near}) => near > 0.01);
  expect(seen.map(({direction}) => direction)).toEqual(['+z']);
  expect(seen[0]!.matrix.map((x) => x + 0)).toEqual([1, 0, 0, 1, 0, 0]);
});

test('aCameraInFrontSeesTheFrontUpright', () => {
  const places = facePlaces([
    [1, 0, 0],
    [0, 0, 1],
    [0, -1, 0],
  ]);
  const seen = places.filter(({near}) => near > 0.01);
  expect(seen.map(({direction}) => direction)).toEqual(['-y']);
  seen[0]!.matrix.forEach((x, i) => expect(x).toBeCloseTo([1, 0, 0, 1, 0, 0][i]!));
});

test('oppositeFacesAreNeverSeenTogether', () => {
  const places = facePlaces(fromThere());
  for (let i = 0; i < 6; i += 2) expect(places[i]!.near).toBeCloseTo(-places[i + 1]!.near);
});

test('aTapBesideTheFacesTakesTheNearestOneThatIsSeen', () => {
  const places = facePlaces(fromThere());
  const seen = places.filter(({near}) => near > 0.01);
  expect(seen.length).toBe(3);
  for (const {direction, matrix} of seen)
    expect(nearestFace(places, 1.6 * matrix[4], 1.6 * matrix[5])).toBe(direction);
  const above = facePlaces(kFromAbove);
  expect(nearestFace(above, -29, 29)).toBe('+z');
});
