// A warp moves the mesh's vertices by a field of vectors: the deformed shape of a solid.

import type {FieldInfo} from '../protocol/fields';
import {kMissing} from './field_scale';
import {isHole, type Cells} from './section';

/** A point field of three components, and the factor of its vectors; 1 is the true size. */
export interface Warp {
  field: number;
  scale: number;
}

type Movable = Pick<Cells, 'points' | 'tetrahedra'>;

/** Vertices stay within the lattice's integers, whatever the factor is. */
const kFarthest = 2 ** 30;

/**
 * The places of the vertices, moved by `factor` times their vectors, in lattice coordinates.
 * `values` holds three integers of the field `info` for each vertex. A vertex whose vector is
 * missing moves as its neighbours do. It stays where it is if no vertex near it moves.
 */
export function warpedPoints(
  {points, tetrahedra}: Movable,
  values: Int32Array,
  {minimum, step}: Pick<FieldInfo, 'minimum' | 'step'>,
  factor: number,
): Int32Array {
  const moved = points.slice();
  const moves = new Uint8Array(points.length / 3);
  let missing = 0;
  for (let v = 0, i = 0; v < moves.length; ++v, i += 3) {
    if (values[i] === kMissing || values[i + 1] === kMissing || values[i + 2] === kMissing) {
      ++missing;
      continue;
    }
    moves[v] = 1;
    for (let c = 0; c < 3; ++c)
      moved[i + c] = limited(points[i + c]! + factor * (minimum[c]! + step * values[i + c]!));
  }
  if (missing > 0 && missing < moves.length) followNeighbours({points, tetrahedra}, moved, moves);
  return moved;
}

const limited = (place: number): number =>
  Math.round(Math.min(kFarthest, Math.max(-kFarthest, place)));

/** The sum of some ways, and their count. */
type Ways = [x: number, y: number, z: number, count: number];

/**
 * Each round moves the vertices beside moved ones by their mean. New vertices of a finer mesh have
 * no vectors yet, and stand beside vertices that have.
 */
function followNeighbours(mesh: Movable, moved: Int32Array, moves: Uint8Array): void {
  let ways: Map<number, Ways>;
  do {
    ways = waysBeside(mesh, moved, moves);
    for (const [vertex, [x, y, z, count]] of ways) {
      moves[vertex] = 1;
      [x, y, z].forEach((way, c) => {
        moved[3 * vertex + c] = limited(mesh.points[3 * vertex + c]! + way / count);
      });
    }
  } while (ways.size > 0);
}

/** For each vertex that rests beside moved ones: their ways. */
function waysBeside(
  {points, tetrahedra}: Movable,
  moved: Int32Array,
  moves: Uint8Array,
): Map<number, Ways> {
  const found = new Map<number, Ways>();
  for (let at = 0; at < tetrahedra.length; at += 4) {
    if (isHole(tetrahedra, at >> 2)) continue;
    let count = 0;
    for (let i = at; i < at + 4; ++i) count += moves[tetrahedra[i]!]!;
    if (count === 0 || count === 4) continue;
    const corners = [...tetrahedra.subarray(at, at + 4)];
    const still = corners.filter((corner) => moves[corner] === 0);
    const sum = sumOfWays(
      points,
      moved,
      corners.filter((corner) => moves[corner] === 1),
    );
    for (const vertex of still) {
      const before = found.get(vertex);
      found.set(vertex, before ? (sum.map((way, i) => way + before[i]!) as Ways) : sum);
    }
  }
  return found;
}

function sumOfWays(points: Int32Array, moved: Int32Array, vertices: number[]): Ways {
  const along = (axis: number): number =>
    vertices.reduce((sum, v) => sum + moved[3 * v + axis]! - points[3 * v + axis]!, 0);
  return [along(0), along(1), along(2), vertices.length];
}
