// The creases of a surface as lines.

import type {Plane} from '../protocol/geometry';

/** The corners at the ends of the side opposite to corner 0, 1, 2. */
const kEnds = [
  [1, 2],
  [2, 0],
  [0, 1],
] as const;

/**
 * The ends of the lines: 6 lattice coordinates each. `creases` is creasesOf the triangles, where a
 * side comes from both its triangles. The parts of lines above any of the planes are left out.
 */
export function creaseLines(
  points: Int32Array,
  triangles: Uint32Array,
  creases: Uint8Array,
  planes: readonly Plane[],
): Float32Array {
  const lines: number[] = [];
  for (let at = 0; at < triangles.length; at += 3) {
    for (let bits = creases[at]!, side = 0; bits > 0; bits >>= 1, ++side) {
      const [i, j] = kEnds[side]!;
      const from = 3 * triangles[at + i]!;
      const to = 3 * triangles[at + j]!;
      if ((bits & 1) === 0 || from > to) continue;
      const line = [...points.subarray(from, from + 3), ...points.subarray(to, to + 3)];
      lines.push(...below(line, planes));
    }
  }
  return Float32Array.from(lines);
}

/** The part of the line below all planes; empty: there is none. */
function below(line: number[], planes: readonly Plane[]): number[] {
  let low = 0;
  let high = 1;
  for (const {normal, offset} of planes) {
    const height = (end: number): number =>
      normal.reduce((sum, part, axis) => sum + part * line[end + axis]!, -offset);
    const [from, to] = [height(0), height(3)];
    if (from > 0 && to > 0) return [];
    if (from > 0) low = Math.max(low, from / (from - to));
    else if (to > 0) high = Math.min(high, from / (from - to));
  }
  if (low >= high) return [];
  return [low, high].flatMap((share) =>
    [0, 1, 2].map((axis) => line[axis]! + share * (line[axis + 3]! - line[axis]!)),
  );
}
