import {expect, test} from 'vitest';
import {fadesOf, type Lined} from '../webgl/edge_fade';
import type {Matrix} from '../webgl/matrix';
import type {Size} from '../webgl/pose';

/** Lattice coordinates from -1 to 1 are the canvas. */
const plain = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const canvas = {clientWidth: 400, clientHeight: 400};

/** `count` right triangles with short sides of `pixels`, at (x, 0). */
function triangles(count: number, pixels: number, x = 0): Float32Array {
  const side = pixels / 200;
  return Float32Array.from(
    {length: 9 * count},
    (_, i) => [x, 0, 0, x + side, 0, 0, x, side, 0][i % 9]!,
  );
}

const edgeFade = (soups: Float32Array[], toCanvas: Matrix, size: Size): number =>
  fadesOf(
    soups.map((positions) => ({positions, creases: new Uint8Array(positions.length / 3)})),
    toCanvas,
    size,
  ).edges;

test('edgesAreAsStrongAsCellsAreLarge', () => {
  expect(edgeFade([triangles(10, 20)], plain, canvas)).toBe(1);
  expect(edgeFade([triangles(10, 4)], plain, canvas)).toBe(0);
  const between = edgeFade([triangles(10, 10)], plain, canvas);
  expect(between).toBeGreaterThan(0.2);
  expect(between).toBeLessThan(0.5);
  expect(edgeFade([triangles(10, 5)], plain, {clientWidth: 800, clientHeight: 800})).toBeCloseTo(
    between,
  );
});

test('theCellsThatTakeMostOfTheCanvasDecide', () => {
  // many small cells, and a few large ones with more area
  expect(edgeFade([triangles(1000, 2), triangles(20, 20)], plain, canvas)).toBe(1);
  expect(edgeFade([triangles(1000, 4), triangles(20, 20)], plain, canvas)).toBe(0);
  // what lies beside the canvas, or behind the eye, does not count
  expect(edgeFade([triangles(1000, 20, 3), triangles(5, 4)], plain, canvas)).toBe(0);
  const behind = [...plain.slice(0, 15), -1];
  expect(edgeFade([triangles(10, 20)], behind, canvas)).toBe(0);
  expect(edgeFade([new Float32Array(0)], plain, canvas)).toBe(0);
});

/** The side opposite to the second corner of each triangle is a crease. */
const creased = (positions: Float32Array): Lined => ({
  positions,
  creases: new Uint8Array(positions.length / 3).fill(0b010),
});

test('creasesAreAsStrongAsThereIsSpaceBetweenThem', () => {
  // a triangle's space is as wide as its short side
  const fade = (pixels: number, size = canvas): number =>
    fadesOf([creased(triangles(10, pixels))], plain, size).creases;
  expect(fade(11)).toBe(1);
  expect(fade(2)).toBe(0);
  expect(fade(6)).toBeGreaterThan(0.2);
  expect(fade(6)).toBeLessThan(0.6);
  expect(fade(3, {clientWidth: 800, clientHeight: 800})).toBeCloseTo(fade(6));
});

test('aSurfaceWithFewCreasesKeepsThemHoweverSmallItsCells', () => {
  const many = {positions: triangles(1000, 2), creases: new Uint8Array(3000)};
  expect(fadesOf([many], plain, canvas).creases).toBe(1);
  expect(fadesOf([many, creased(triangles(10, 2))], plain, canvas)).toEqual({edges: 0, creases: 1});
});
