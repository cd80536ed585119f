// How many cells the parts of a mesh have, and how much of its volume.

import type {MeshArrays} from './display';
import {isHole} from './section';

export interface PartCount {
  label: number;
  cells: number;
  /** The share of the mesh's volume. */
  share: number;
}

/** By label, ascending. `labelOf` gives a cell's, NaN if it has none. */
export function countParts(
  {points, tetrahedra}: Pick<MeshArrays, 'points' | 'tetrahedra'>,
  labelOf: (cell: number) => number,
): PartCount[] {
  const found = new Map<number, PartCount>();
  let all = 0;
  for (let cell = 0; 4 * cell < tetrahedra.length; ++cell) {
    if (isHole(tetrahedra, cell)) continue;
    const volume = volumeOf(points, tetrahedra, 4 * cell);
    all += volume;
    const label = labelOf(cell);
    if (Number.isNaN(label)) continue;
    let count = found.get(label);
    if (!count) found.set(label, (count = {label, cells: 0, share: 0}));
    ++count.cells;
    count.share += volume;
  }
  for (const count of found.values()) count.share /= all || 1;
  return [...found.values()].sort((a, b) => a.label - b.label);
}

/** Six times of it. */
function volumeOf(points: Int32Array, tetrahedra: Uint32Array, at: number): number {
  const d = 3 * tetrahedra[at + 3]!;
  const x = [0, 0, 0, 0, 0, 0, 0, 0, 0];
  for (let corner = 0; corner < 3; ++corner)
    for (let axis = 0; axis < 3; ++axis)
      x[3 * corner + axis] = points[3 * tetrahedra[at + corner]! + axis]! - points[d + axis]!;
  const [ax, ay, az, bx, by, bz, cx, cy, cz] = x as [
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
    number,
  ];
  return Math.abs(ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx));
}
