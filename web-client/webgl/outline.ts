// Points that stand for a mesh when a camera is fitted to it.

import type {Vector} from '../core/protocol/geometry';
import type {TriangleSoup} from '../core/picture/triangle_soup';

/** So many directions bound a mesh to a few per cent. */
const kDirections = 128;
/** Only every n-th corner of a larger surface counts: 2.5 million products take 5 ms. */
const kMaxCorners = 20000;

/**
 * The farthest points of a surface in many directions; the corners of its bounds if there is no
 * surface.
 */
export function outlineOf(surface: TriangleSoup | undefined, bounds: number[]): Vector[] {
  const positions = surface?.positions ?? new Float32Array(0);
  return positions.length === 0 ? cornersOf(bounds) : farthest(positions);
}

/** Those of the ends of lines, 6 coordinates each, that are the farthest in many directions. */
export const outlineOfLines = (lines: Float32Array): Vector[] =>
  lines.length === 0 ? [] : farthest(lines);

/** Those of the points that are the farthest in many directions. */
export const farthestOf = (points: Vector[]): Vector[] => farthest(points.flat());

function farthest(positions: ArrayLike<number>): Vector[] {
  const stride = 3 * Math.ceil(positions.length / 3 / kMaxCorners);
  const found = new Map<number, Vector>();
  for (const [x, y, z] of directions()) {
    let best = -Infinity;
    let at = 0;
    for (let i = 0; i < positions.length; i += stride) {
      const height = x * positions[i]! + y * positions[i + 1]! + z * positions[i + 2]!;
      if (height > best) [best, at] = [height, i];
    }
    found.set(at, [positions[at]!, positions[at + 1]!, positions[at + 2]!]);
  }
  return [...found.values()];
}

export function cornersOf(bounds: number[]): Vector[] {
  return Array.from({length: 8}, (_, i) => [
    bounds[i & 1 ? 3 : 0]!,
    bounds[i & 2 ? 4 : 1]!,
    bounds[i & 4 ? 5 : 2]!,
  ]);
}

/** A spiral from pole to pole: about evenly spread. */
function directions(): Vector[] {
  const golden = Math.PI * (3 - Math.sqrt(5));
  return Array.from({length: kDirections}, (_, i) => {
    const z = 1 - (2 * i + 1) / kDirections;
    const radius = Math.sqrt(1 - z * z);
    return [radius * Math.cos(golden * i), radius * Math.sin(golden * i), z];
  });
}
