import {expect, test} from 'vitest';
import {creaseLines} from '../core/picture/crease_lines';
import type {Plane} from '../core/protocol/geometry';

/** Two triangles that share the side from vertex 0 to vertex 1, a crease of both. */
const points = Int32Array.of(0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10);
const triangles = Uint32Array.of(0, 1, 2, 0, 3, 1);
const creases = Uint8Array.of(0b100, 0b100, 0b100, 0b010, 0b010, 0b010);
const linesBelow = (...planes: Plane[]): number[] => [
  ...creaseLines(points, triangles, creases, planes),
];
const x = (offset: number, sign = 1): Plane => ({normal: [sign, 0, 0], offset});

test('aSideOfTwoTrianglesIsOneLine', () => {
  expect(linesBelow()).toEqual([0, 0, 0, 10, 0, 0]);
  expect([...creaseLines(points, triangles, new Uint8Array(6), [])]).toEqual([]);
});

test('eachBitIsTheSideOppositeToItsCorner', () => {
  for (const [bit, corners] of [
    [0, [1, 2]],
    [1, [2, 0]],
    [2, [0, 1]],
  ] as const) {
    const one = creaseLines(points, triangles.subarray(0, 3), new Uint8Array(3).fill(1 << bit), []);
    const ends = corners.flatMap((corner) => [...points.subarray(3 * corner, 3 * corner + 3)]);
    // A side whose other triangle is missing comes from its lower end only.
    expect([...one]).toEqual(corners[0] < corners[1] ? ends : []);
  }
});

test('linesEndAtPlanes', () => {
  expect(linesBelow(x(4))).toEqual([0, 0, 0, 4, 0, 0]);
  expect(linesBelow(x(8), x(-3, -1))).toEqual([3, 0, 0, 8, 0, 0]);
  expect(linesBelow(x(-1))).toEqual([]);
  expect(linesBelow(x(3), x(-6, -1))).toEqual([]);
  expect(linesBelow(x(10))).toEqual([0, 0, 0, 10, 0, 0]);
});
