// The order of triangles that are seen through: the farthest first. It is loaded on use.

import {isClear} from '../core/picture/paint';
import type {Matrix} from './matrix';

/** Depths fall into so many steps: less than a thousandth of the mesh each. */
const kSteps = 4096;

/** The corners of clear triangles, by the depth of their middles. `paint`: 4 bytes a corner. */
export function backToFront(
  positions: Float32Array,
  paint: Uint8Array,
  toEye: Matrix,
): Uint32Array {
  const triangles = clearTriangles(paint);
  const [x, y, z] = [toEye[2]!, toEye[6]!, toEye[10]!];
  const depths = new Float32Array(triangles.length);
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < depths.length; ++i) {
    const at = 9 * triangles[i]!;
    let depth = 0;
    for (let k = at; k < at + 9; k += 3)
      depth += x * positions[k]! + y * positions[k + 1]! + z * positions[k + 2]!;
    depths[i] = depth;
    if (depth < low) low = depth;
    if (depth > high) high = depth;
  }
  const factor = high > low ? (kSteps - 1) / (high - low) : 0;
  const stepOf = (i: number): number => Math.trunc((depths[i]! - low) * factor);
  const starts = new Uint32Array(kSteps + 1);
  for (let i = 0; i < depths.length; ++i) ++starts[stepOf(i) + 1]!;
  for (let step = 0; step < kSteps; ++step) starts[step + 1]! += starts[step]!;
  const corners = new Uint32Array(3 * triangles.length);
  for (let i = 0; i < depths.length; ++i) {
    const to = 3 * starts[stepOf(i)]!++;
    for (let k = 0; k < 3; ++k) corners[to + k] = 3 * triangles[i]! + k;
  }
  return corners;
}

function clearTriangles(paint: Uint8Array): Uint32Array {
  const found = new Uint32Array(paint.length / 12);
  let count = 0;
  for (let triangle = 0; triangle < found.length; ++triangle)
    if (isClear(paint[12 * triangle + 3]!)) found[count++] = triangle;
  return found.subarray(0, count);
}
