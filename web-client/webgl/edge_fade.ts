// How strong the edges of cells are drawn: one strength for all of them, by the size of the cells
// on the canvas. A strength for each cell would leave crumbs between cells without edges.

import type {Vector} from '../core/protocol/geometry';
import type {Matrix} from './matrix';
import type {Size} from './pose';

/** So many triangles tell the sizes of all. */
const kSamples = 1500;
/** Edges fade below this size of a cell, in pixels, and are gone at kGone. */
const kFull = 18;
const kGone = 5;

/**
 * The strength in [0, 1]. `soups` hold 9 lattice coordinates a triangle. Half of the area on the
 * canvas has cells of the size that decides, or larger ones.
 */
export function edgeFade(soups: readonly Float32Array[], toCanvas: Matrix, canvas: Size): number {
  const size = medianSize(soups, toCanvas, canvas);
  const at = Math.min(1, Math.max(0, (size - kGone) / (kFull - kGone)));
  return at * at * (3 - 2 * at);
}

function medianSize(
  soups: readonly Float32Array[],
  toCanvas: Matrix,
  {clientWidth, clientHeight}: Size,
): number {
  const count = soups.reduce((sum, {length}) => sum + length / 9, 0);
  const stride = 9 * Math.ceil(count / kSamples);
  const areas: number[] = [];
  for (const soup of soups) {
    for (let at = 0; at < soup.length; at += stride) {
      const area = seenArea(soup, at, toCanvas);
      if (area > 0) areas.push((area * clientWidth * clientHeight) / 4);
    }
  }
  areas.sort((a, b) => a - b);
  let rest = areas.reduce((sum, area) => sum + area, 0) / 2;
  const median = areas.find((area) => (rest -= area) <= 0) ?? 0;
  return Math.sqrt(2 * median);
}

type Point = [number, number];

/** In squares of half of the canvas; 0 if its middle is not on the canvas. */
function seenArea(soup: Float32Array, at: number, m: Matrix): number {
  const seen = [0, 3, 6].map((corner) => {
    const [x, y, z] = soup.subarray(at + corner, at + corner + 3) as unknown as Vector;
    const row = (i: number): number => m[i]! * x + m[i + 4]! * y + m[i + 8]! * z + m[i + 12]!;
    const w = row(3);
    return w > 0 ? [row(0) / w, row(1) / w] : [Infinity, Infinity];
  });
  const [[ax, ay], [bx, by], [cx, cy]] = seen as [Point, Point, Point];
  const isSeen = Math.abs(ax + bx + cx) < 3 && Math.abs(ay + by + cy) < 3;
  return isSeen ? Math.abs((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2 : 0;
}
