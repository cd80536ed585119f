import {expect, test} from 'vitest';
import {creasesOf} from '../core/picture/creases';

type Point = [number, number, number];
type Triangle = [number, number, number];
interface Surface {
  points: Point[];
  triangles: Triangle[];
}

const kSize = 4096;
const box = (height: number): Surface => ({
  points: [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [
    i & 1 ? kSize : 0,
    i & 2 ? kSize : 0,
    i & 4 ? height : 0,
  ]),
  triangles: [
    ...[
      [0, 2, 3],
      [0, 3, 1],
      [4, 5, 7],
      [4, 7, 6],
      [0, 1, 5],
      [0, 5, 4],
    ],
    ...[
      [2, 6, 7],
      [2, 7, 3],
      [0, 4, 6],
      [0, 6, 2],
      [1, 3, 7],
      [1, 7, 5],
    ],
  ] as Triangle[],
});
const octahedron: Surface = {
  points: [
    [kSize, 0, 0],
    [-kSize, 0, 0],
    [0, kSize, 0],
    [0, -kSize, 0],
    [0, 0, kSize],
    [0, 0, -kSize],
  ],
  triangles: [
    [0, 2, 4],
    [2, 1, 4],
    [1, 3, 4],
    [3, 0, 4],
    [2, 0, 5],
    [1, 2, 5],
    [3, 1, 5],
    [0, 3, 5],
  ],
};

const onBall = (place: Point): Point =>
  place.map((x) => Math.round((kSize * x) / Math.hypot(...place))) as Point;

/** Each triangle as four, with new points moved by `move`. */
function refined({points, triangles}: Surface, move = (place: Point): Point => place): Surface {
  const out: Surface = {points: [...points], triangles: []};
  const middles = new Map<string, number>();
  const middle = (a: number, b: number): number => {
    const key = String([Math.min(a, b), Math.max(a, b)]);
    const id = middles.get(key) ?? out.points.length;
    if (!middles.has(key))
      out.points.push(move(points[a]!.map((x, axis) => (x + points[b]![axis]!) / 2) as Point));
    middles.set(key, id);
    return id;
  };
  for (const [a, b, c] of triangles) {
    const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
    out.triangles.push([a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]);
  }
  return out;
}

const creaseSides = ({points, triangles}: Surface): number =>
  creasesOf(Int32Array.from(points.flat()), Uint32Array.from(triangles.flat())).reduce(
    (sum, bits) => sum + (bits & 1) + ((bits >> 1) & 1) + ((bits >> 2) & 1),
    0,
  );

test('theEdgesOfABoxAreCreasesFromBothSides', () => {
  for (const height of [kSize, kSize / 64]) {
    let surface = box(height);
    for (let parts = 1; parts <= 4; parts *= 2) {
      expect(creaseSides(surface)).toBe(2 * 12 * parts);
      surface = refined(surface);
    }
  }
});

test('aBallHasNoCreaseHoweverCoarse', () => {
  let surface = octahedron;
  for (let times = 0; times < 4; ++times) {
    expect(creaseSides(surface)).toBe(0);
    surface = refined(surface, onBall);
  }
});

test('aShortCreaseIsLeftOut', () => {
  // a fold between two triangles, each of which goes on flat; and a point far away
  const fold = (far: number): Surface => ({
    points: [
      [0, 0, 0],
      [0, 10, 0],
      [10, 5, 0],
      [0, 5, 10],
      [10, -5, 0],
      [0, -5, 10],
      [far, 0, 0],
    ],
    triangles: [
      [0, 2, 1],
      [0, 1, 3],
      [0, 4, 2],
      [0, 3, 5],
    ],
  });
  expect(creaseSides(fold(199))).toBe(2);
  expect(creaseSides(fold(201))).toBe(0);
});

test('boxesThatShareAnEdgeDoNotMixTheirSides', () => {
  const one = box(kSize);
  const ids = [3, 8, 9, 10, 7, 11, 12, 13]; // of the second box, which begins at the first's corner
  const two: Surface = {
    points: [...one.points, ...[1, 2, 3, 5, 6, 7].map((i) => shifted(one.points[i]!))],
    triangles: [
      ...one.triangles,
      ...one.triangles.map((corners) => corners.map((id) => ids[id]!) as Triangle),
    ],
  };
  expect(creaseSides(two)).toBe(2 * 2 * 12);
});

function shifted([x, y, z]: Point): Point {
  return [x + kSize, y + kSize, z];
}
