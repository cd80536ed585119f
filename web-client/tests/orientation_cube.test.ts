import {expect, test} from 'vitest';
import {facePlaces, nearestFace} from '../viewer/panels/orientation_cube';

const kHalfTurn = Math.SQRT1_2;

test('aCameraFromAboveSeesTheTopUpright', () => {
  const places = facePlaces({x: 0, y: 0, z: 0, w: 1}); // three's camera looks along -z
  const seen = places.filter(({near}) => near > 0.01);
  expect(seen.map(({direction}) => direction)).toEqual(['+z']);
  expect(seen[0]!.matrix.map((x) => x + 0)).toEqual([1, 0, 0, 1, 0, 0]);
});

test('aCameraInFrontSeesTheFrontUpright', () => {
  // Turned by a right angle round x: it looks along +y, from -y, and z is up.
  const places = facePlaces({x: kHalfTurn, y: 0, z: 0, w: kHalfTurn});
  const seen = places.filter(({near}) => near > 0.01);
  expect(seen.map(({direction}) => direction)).toEqual(['-y']);
  seen[0]!.matrix.forEach((x, i) => expect(x).toBeCloseTo([1, 0, 0, 1, 0, 0][i]!));
});

test('oppositeFacesAreNeverSeenTogether', () => {
  const places = facePlaces({x: 0.5, y: 0.1, z: 0.3, w: Math.sqrt(1 - 0.35)});
  for (let i = 0; i < 6; i += 2) expect(places[i]!.near).toBeCloseTo(-places[i + 1]!.near);
});

test('aTapBesideTheFacesTakesTheNearestOneThatIsSeen', () => {
  const places = facePlaces({x: 0.5, y: 0.1, z: 0.3, w: Math.sqrt(1 - 0.35)});
  const seen = places.filter(({near}) => near > 0.01);
  expect(seen.length).toBe(3);
  for (const {direction, matrix} of seen)
    expect(nearestFace(places, 1.6 * matrix[4], 1.6 * matrix[5])).toBe(direction);
  const above = facePlaces({x: 0, y: 0, z: 0, w: 1});
  expect(nearestFace(above, -29, 29)).toBe('+z');
});
