// How strong lines are drawn. All edges of cells have one strength, by the size of the cells on the
// canvas. All creases have one, by the space between them. A strength for each line would leave
// crumbs between cells without edges.

import type {Vector} from '../core/protocol/geometry';
import type {Matrix} from './matrix';
import type {Size} from './pose';

/** So many triangles tell the sizes of all. */
const kSamples = 1500;
/** Edges fade below this size of a cell, in pixels, and are gone at kGone. */
const kFull = 18;
const kGone = 5;
/** The same for creases and the space between them: a small picture would be all lines. */
const kFullSpace = 10;
const kGoneSpace = 3;

/** Triangles with 9 lattice coordinates each. */
export interface Lined {
  positions: Float32Array;
  /** TriangleSoup.creases. */
  creases: Uint8Array;
}

/** Both in [0, 1]. */
export interface Fades {
  edges: number;
  creases: number;
}

/**
 * Half of the area on the canvas has cells of the size that decides about edges, or larger ones.
 * The space between creases is the area for each pixel of their length.
 */
export function fadesOf(soups: readonly Lined[], toCanvas: Matrix, canvas: Size): Fades {
  const count = soups.reduce((sum, {positions}) => sum + positions.length / 9, 0);
  const stride = Math.ceil(count / kSamples);
  const areas: number[] = [];
  let creaseLength = 0;
  for (const {positions, creases} of soups) {
    for (let at = 0; at < positions.length / 9; at += stride) {
      const seen = cornersSeen(positions, 9 * at, toCanvas, canvas);
      const area = seen ? areaOf(seen) : 0;
      if (area === 0) continue;
      areas.push(area);
      creaseLength += lengthOf(seen!, creases[3 * at]!) / 2; // it is a side of two triangles
    }
  }
  const all = areas.reduce((sum, area) => sum + area, 0);
  return {
    edges: fade(medianSize(areas, all), kGone, kFull),
    creases: creaseLength > 0 ? fade(all / creaseLength, kGoneSpace, kFullSpace) : 1,
  };
}

function fade(size: number, gone: number, full: number): number {
  const at = Math.min(1, Math.max(0, (size - gone) / (full - gone)));
  return at * at * (3 - 2 * at);
}

function medianSize(areas: number[], all: number): number {
  areas.sort((a, b) => a - b);
  let rest = all / 2;
  const median = areas.find((area) => (rest -= area) <= 0) ?? 0;
  return Math.sqrt(2 * median);
}

type Point = [number, number];
type Corners = [Point, Point, Point];

/** In pixels from the canvas's middle; null if the triangle's middle is not on the canvas. */
function cornersSeen(
  soup: Float32Array,
  at: number,
  m: Matrix,
  {clientWidth, clientHeight}: Size,
): Corners | null {
  const seen = [0, 3, 6].map((corner) => {
    const [x, y, z] = soup.subarray(at + corner, at + corner + 3) as unknown as Vector;
    const row = (i: number): number => m[i]! * x + m[i + 4]! * y + m[i + 8]! * z + m[i + 12]!;
    const w = row(3);
    return w > 0
      ? [((row(0) / w) * clientWidth) / 2, ((row(1) / w) * clientHeight) / 2]
      : [Infinity, Infinity];
  }) as Corners;
  const [[ax, ay], [bx, by], [cx, cy]] = seen;
  const isSeen =
    Math.abs(ax + bx + cx) < 1.5 * clientWidth && Math.abs(ay + by + cy) < 1.5 * clientHeight;
  return isSeen ? seen : null;
}

function areaOf([[ax, ay], [bx, by], [cx, cy]]: Corners): number {
  return Math.abs((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2;
}

/** The length of the sides whose bits are set. */
function lengthOf(corners: Corners, sides: number): number {
  let length = 0;
  for (let k = 0; k < 3; ++k) {
    if (((sides >> k) & 1) === 0) continue;
    const [[ax, ay], [bx, by]] = [corners[(k + 1) % 3]!, corners[(k + 2) % 3]!];
    length += Math.hypot(bx - ax, by - ay);
  }
  return length;
}
