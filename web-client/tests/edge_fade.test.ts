import {expect, test} from 'vitest';
import {edgeFade} from '../webgl/edge_fade';

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
