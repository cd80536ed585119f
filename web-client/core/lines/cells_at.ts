// The cells that hold many places, found in one pass over the mesh.

import type {Vector} from '../protocol/geometry';
import type {VectorWalk} from './vector_walk';

/** Boxes along an axis at most, into which the places are sorted. */
const kMostBoxes = 96;

/**
 * By place the first cell that holds it; -1: none does. Places are on the lattice. The body is one
 * loop: calls would take several times as long.
 */
export function cellsAt(walk: VectorWalk, places: readonly Vector[]): Int32Array {
  const {points, tetrahedra} = walk.mesh;
  const found = new Int32Array(places.length).fill(-1);
  if (places.length === 0) return found;
  const {low, perBox, counts, first, order} = sorted(places);
  const [x0, y0, z0] = [low[0]!, low[1]!, low[2]!];
  const [sx, sy, sz] = [perBox[0]!, perBox[1]!, perBox[2]!];
  const [nx, ny, nz] = [counts[0]!, counts[1]!, counts[2]!];
  for (let cell = 0; cell < tetrahedra.length / 4; ++cell) {
    const a = 3 * tetrahedra[4 * cell]!;
    const b = 3 * tetrahedra[4 * cell + 1]!;
    const c = 3 * tetrahedra[4 * cell + 2]!;
    const d = 3 * tetrahedra[4 * cell + 3]!;
    if (a === b) continue;
    const ax = points[a]!;
    const bx = points[b]!;
    const cx = points[c]!;
    const dx = points[d]!;
    const lowX = (Math.min(ax, bx, cx, dx) - x0) * sx;
    const highX = (Math.max(ax, bx, cx, dx) - x0) * sx;
    if (lowX >= nx || highX < 0) continue;
    const fromX = Math.max(0, Math.floor(lowX));
    const toX = Math.floor(Math.min(nx - 1, highX));
    const ay = points[a + 1]!;
    const by = points[b + 1]!;
    const cy = points[c + 1]!;
    const dy = points[d + 1]!;
    const lowY = (Math.min(ay, by, cy, dy) - y0) * sy;
    const highY = (Math.max(ay, by, cy, dy) - y0) * sy;
    if (lowY >= ny || highY < 0) continue;
    const fromY = Math.max(0, Math.floor(lowY));
    const toY = Math.floor(Math.min(ny - 1, highY));
    const az = points[a + 2]!;
    const bz = points[b + 2]!;
    const cz = points[c + 2]!;
    const dz = points[d + 2]!;
    const lowZ = (Math.min(az, bz, cz, dz) - z0) * sz;
    const highZ = (Math.max(az, bz, cz, dz) - z0) * sz;
    if (lowZ >= nz || highZ < 0) continue;
    const fromZ = Math.max(0, Math.floor(lowZ));
    const toZ = Math.floor(Math.min(nz - 1, highZ));
    const wide = toY - fromY + 1;
    for (let k = 0; k < wide * (toZ - fromZ + 1); ++k) {
      const row = ((fromZ + Math.floor(k / wide)) * ny + fromY + (k % wide)) * nx;
      const end = first[row + toX + 1]!;
      for (let i = first[row + fromX]!; i < end; ++i) {
        const place = order[i]!;
        const isNew = found[place] === -1 && walk.holds(cell, places[place]!);
        found[place] = isNew ? cell : found[place]!;
      }
    }
  }
  return found;
}

interface PlaceBoxes {
  low: number[];
  /** Boxes along a unit of an axis, and their counts. */
  perBox: number[];
  counts: number[];
  /** The places of box b are order[first[b]] to order[first[b + 1] - 1]. */
  first: Uint32Array;
  order: Uint32Array;
}

function sorted(places: readonly Vector[]): PlaceBoxes {
  const axes = [0, 1, 2] as const;
  const low = axes.map((axis) => places.reduce((least, at) => Math.min(least, at[axis]), Infinity));
  const sizes = axes.map(
    (axis) => places.reduce((most, at) => Math.max(most, at[axis]), -Infinity) - low[axis]!,
  );
  const most = Math.min(kMostBoxes, Math.ceil(2 * Math.cbrt(places.length)));
  const counts = sizes.map((size) => (size > 0 ? most : 1));
  // the highest places are in the last box; one box holds all that is on its level
  const perBox = sizes.map((size, axis) => (size > 0 ? (counts[axis]! * (1 - 1e-9)) / size : 1));
  const boxOf = places.map((place) => {
    const [x, y, z] = axes.map((axis) => Math.floor((place[axis] - low[axis]!) * perBox[axis]!));
    return (z! * counts[1]! + y!) * counts[0]! + x!;
  });
  const first = new Uint32Array(counts.reduce((all, count) => all * count) + 1);
  for (const box of boxOf) first[box + 1] = first[box + 1]! + 1;
  for (let box = 1; box < first.length; ++box) first[box] = first[box]! + first[box - 1]!;
  const next = first.slice();
  const order = new Uint32Array(places.length);
  boxOf.forEach((box, place) => {
    const at = next[box]!;
    order[at] = place;
    next[box] = at + 1;
  });
  return {low, perBox, counts, first, order};
}
