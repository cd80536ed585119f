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

/** A prism over a regular polygon, with a vertex in the middle of each of its ends. */
function prism(parts: number): Surface {
  const points: Point[] = [
    [0, 0, -kSize],
    [0, 0, kSize],
  ];
  const triangles: Triangle[] = [];
  for (let i = 0; i < parts; ++i) {
    const angle = (2 * Math.PI * i) / parts;
    const [x, y] = [Math.cos(angle), Math.sin(angle)].map((at) => Math.round(kSize * at));
    points.push([x!, y!, -kSize], [x!, y!, kSize]);
    const [a, b] = [2 + 2 * i, 2 + 2 * ((i + 1) % parts)];
    triangles.push([0, b, a], [1, a + 1, b + 1], [a, b, b + 1], [a, b + 1, a + 1]);
  }
  return {points, triangles};
}

/** The sides that bend by more than 30 degrees, each from both its triangles. */
function sharpSides({points, triangles}: Surface): number {
  const normals = new Map<string, Point>();
  for (const [a, b, c] of triangles) {
    const [u, v] = [b, c].map((id) => points[id]!.map((x, axis) => x - points[a]![axis]!));
    const normal = [0, 1, 2].map((i) => {
      const [j, k] = [(i + 1) % 3, (i + 2) % 3];
      return u![j]! * v![k]! - u![k]! * v![j]!;
    });
    const unit = normal.map((x) => x / Math.hypot(...normal)) as Point;
    for (const side of [
      [a, b],
      [b, c],
      [c, a],
    ])
      normals.set(String(side), unit);
  }
  const bends = [...normals].map(([side, normal]) => {
    const other = normals.get(side.split(',').reverse().join())!;
    return normal.reduce((sum, x, axis) => sum + x * other[axis]!, 0);
  });
  return bends.filter((bend) => bend < Math.cos(Math.PI / 6)).length;
}

const creaseSides = ({points, triangles}: Surface): number =>
  creasesOf(Int32Array.from(points.flat()), Uint32Array.from(triangles.flat())).reduce(
    (sum, bits, side) => sum + ((bits >> (side % 3)) & 1),
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

test('aRoughBallHasNoCrease', () => {
  let surface = octahedron;
  for (let times = 0; times < 4; ++times) surface = refined(surface, onBall);
  // every vertex nearer to the middle or farther from it by up to a twelfth, in no order
  surface.points = surface.points.map(
    (place, i) => place.map((x) => Math.round(x * (1 + (((i * 7919) % 101) - 50) / 600))) as Point,
  );
  expect(sharpSides(surface)).toBeGreaterThan(surface.triangles.length / 20);
  expect(creaseSides(surface)).toBe(0);
});

test('theRimsOfACylinderAreItsOnlyCreases', () => {
  for (const parts of [16, 64]) {
    let surface = prism(parts);
    for (let times = 1; times <= 4; times *= 2) {
      expect(creaseSides(surface)).toBe(2 * 2 * parts * times);
      surface = refined(surface);
    }
  }
});

test('aCreaseBendsByMoreThan30Degrees', () => {
  expect(creaseSides(refined(prism(13)))).toBe(2 * 2 * 13 * 2); // its sides bend by 27.7 degrees
  expect(creaseSides(refined(prism(11)))).toBe(2 * (2 * 11 * 2 + 11 * 2)); // by 32.7
});

test('aShortCreaseIsLeftOut', () => {
  // the creases of a box hang together; a point far away makes them short
  const length = 12 * kSize;
  const among = (far: number): Surface => {
    const {points, triangles} = box(kSize);
    return {points: [...points, [far, 0, 0]], triangles};
  };
  expect(creaseSides(among(10 * length - 10))).toBe(2 * 12);
  expect(creaseSides(among(10 * length + 10))).toBe(0);
});

test('aCreaseOfFewSidesIsLeftOut', () => {
  // a flat strip that is folded along its middle
  const fold = (parts: number): Surface => ({
    points: Array.from({length: parts + 1}, (_, i) => i * kSize).flatMap((x): Point[] => [
      [x, -kSize, kSize],
      [x, 0, 0],
      [x, kSize, kSize],
    ]),
    triangles: Array.from({length: parts}, (_, i) => 3 * i).flatMap((at): Triangle[] => [
      [at, at + 3, at + 1],
      [at + 1, at + 3, at + 4],
      [at + 1, at + 4, at + 2],
      [at + 2, at + 4, at + 5],
    ]),
  });
  expect(creaseSides(fold(4))).toBe(2 * 4);
  expect(creaseSides(fold(3))).toBe(0);
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
