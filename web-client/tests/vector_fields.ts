// Boxes with vectors at their vertices.

import {kMissing} from '../core/picture/field_scale';
import {neighboursOf} from '../core/picture/neighbours';
import type {FieldInfo} from '../core/protocol/fields';
import type {Vector} from '../core/protocol/geometry';
import type {Vectors, WalkMesh} from '../core/lines/vector_walk';
import {allVertices, cubes} from './cubes';

/** `side` cubes along each side of a box of this size. */
export function boxMesh(
  side: number,
  size: number,
): WalkMesh & {boundary: Uint32Array; step: number} {
  const {points, tetrahedra} = cubes(side, size / side);
  const neighbours = neighboursOf(tetrahedra);
  return {
    points: points.map(Math.round),
    tetrahedra,
    boundary: allVertices(points),
    step: 1,
    across: (cell, corner) => neighbours[4 * cell + corner]! >>> 0,
  };
}

/** Integers that stand for themselves; null: the vector is missing. */
export function vectorsOf({points}: WalkMesh, at: (place: Vector) => Vector | null): Vectors {
  const values = new Int32Array(points.length);
  let longest = 0;
  for (let i = 0; i < points.length; i += 3) {
    const vector = at([points[i]!, points[i + 1]!, points[i + 2]!]);
    values.set(vector?.map(Math.round) ?? [kMissing, kMissing, kMissing], i);
    longest = Math.max(longest, Math.hypot(...(vector ?? [])));
  }
  const info = {
    name: 'U',
    components: 3,
    type: 'float32',
    association: 'point',
    step: 1,
    minimum: [0, 0, 0],
    range: [0, longest],
  } as unknown as FieldInfo;
  return {values, info};
}
