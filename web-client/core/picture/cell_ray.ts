// A straight line through the cells, for picking and for probing a field. It is exact: each cell
// has its own stretch of the line, and nothing is sampled.

import {cross, dot, type Plane, type Vector} from '../protocol/geometry';
import {barycentric, minus, pointOf, type Ray} from './cell_value';
import type {Cells} from './section';

export {along, barycentric, valueAt, type Ray} from './cell_value';

/** The line is inside `cell` for t in [from, to]. */
export interface Stretch {
  cell: number;
  from: number;
  to: number;
}

/** Every kept cell that the line passes between t = `first` and t = `last`, in no order. */
export function stretches(cells: Cells, ray: Ray, first: number, last: number): Stretch[] {
  const {points, tetrahedra, kept} = cells;
  const [across, up] = sideways(ray.direction);
  const s = new Float64Array(points.length / 3);
  const u = new Float64Array(points.length / 3);
  // Project along the line, so that it becomes the origin of a plane. Cells that do not surround
  // the origin are skipped.
  for (let v = 0; v < s.length; ++v) {
    const x = points[3 * v]! - ray.origin[0],
      y = points[3 * v + 1]! - ray.origin[1],
      z = points[3 * v + 2]! - ray.origin[2];
    s[v] = x * across[0] + y * across[1] + z * across[2];
    u[v] = x * up[0] + y * up[1] + z * up[2];
  }
  const found: Stretch[] = [];
  for (let cell = 0, at = 0; at < tetrahedra.length; ++cell, at += 4) {
    if (kept?.[cell] === 0) continue;
    const a = tetrahedra[at]!,
      b = tetrahedra[at + 1]!,
      c = tetrahedra[at + 2]!,
      d = tetrahedra[at + 3]!;
    if (s[a]! > 0 && s[b]! > 0 && s[c]! > 0 && s[d]! > 0) continue;
    if (s[a]! < 0 && s[b]! < 0 && s[c]! < 0 && s[d]! < 0) continue;
    if (u[a]! > 0 && u[b]! > 0 && u[c]! > 0 && u[d]! > 0) continue;
    if (u[a]! < 0 && u[b]! < 0 && u[c]! < 0 && u[d]! < 0) continue;
    const inside = insideOf(points, [a, b, c, d], ray, first, last);
    if (inside) found.push({cell, ...inside});
  }
  return found;
}

/** A place on a line; null: no cell is there. */
export interface LinePlace {
  t: number;
  cell: number | null;
}

/** Places closer than this, as a share of the line, are one. */
const kSamePlace = 1e-6;

/**
 * Where a line enters and leaves cells, in order and each place once. Between two cells it is the
 * cell ahead. A stretch without cells has one place, in its middle.
 */
export function placesOf(found: readonly Stretch[]): LinePlace[] {
  const places: LinePlace[] = [];
  let end = -Infinity;
  for (const {cell, from, to} of [...found].sort((a, b) => a.from - b.from)) {
    if (to - from <= kSamePlace) continue; // it only touches the line
    if (from > end + kSamePlace) {
      if (places.length > 0) places.push({t: (end + from) / 2, cell: null});
      places.push({t: from, cell});
    } else if (from > end - kSamePlace) places.at(-1)!.cell = cell;
    if (to <= end + kSamePlace) continue;
    places.push({t: to, cell});
    end = to;
  }
  return places;
}

/** Shortens a stretch to the part below every plane; null if nothing is left. */
export function below(planes: readonly Plane[], ray: Ray, stretch: Stretch): Stretch | null {
  let {from, to} = stretch;
  for (const {normal, offset} of planes) {
    const rate = dot(normal, ray.direction);
    const start = offset - dot(normal, ray.origin);
    if (rate > 0) to = Math.min(to, start / rate);
    else if (rate < 0) from = Math.max(from, start / rate);
    else if (start < 0) return null;
  }
  return from < to ? {cell: stretch.cell, from, to} : null;
}

/** A place this near to a cell, in lattice units, may be its own: places are rounded. */
const kNearby = 0.5;

/** The cell at a place, or else one beside it; -1 if there are no cells. */
export function cellAt(cells: Cells, place: Vector): number {
  const count = cells.tetrahedra.length / 4;
  let nearest = Infinity;
  for (let cell = 0; cell < count; ++cell)
    nearest = Math.min(nearest, boxDistance(cells, cell, place));
  let best = -1;
  let most = -Infinity;
  for (let cell = 0; cell < count; ++cell) {
    if (boxDistance(cells, cell, place) > Math.max(nearest, kNearby)) continue;
    const least = Math.min(...barycentric(cells, cell, place));
    if (least > most) [best, most] = [cell, least];
  }
  return best;
}

/** The largest distance along an axis from the cell's box to a place; Infinity for a hole. */
function boxDistance({points, tetrahedra}: Cells, cell: number, place: Vector): number {
  const a = 3 * tetrahedra[4 * cell]!,
    b = 3 * tetrahedra[4 * cell + 1]!,
    c = 3 * tetrahedra[4 * cell + 2]!,
    d = 3 * tetrahedra[4 * cell + 3]!;
  if (a === b) return Infinity;
  let most = 0;
  for (let axis = 0; axis < 3; ++axis) {
    const x = place[axis]!;
    const [p, q, r, s] = [
      points[a + axis]!,
      points[b + axis]!,
      points[c + axis]!,
      points[d + axis]!,
    ];
    most = Math.max(most, Math.min(p, q, r, s) - x, x - Math.max(p, q, r, s));
  }
  return most;
}

function insideOf(
  points: Int32Array,
  corners: Vector4,
  ray: Ray,
  first: number,
  last: number,
): {from: number; to: number} | null {
  let from = first;
  let to = last;
  for (let i = 0; i < 4; ++i) {
    const inner = pointOf(points, corners[i]!);
    const p = pointOf(points, corners[(i + 1) & 3]!);
    const normal = cross(
      minus(pointOf(points, corners[(i + 2) & 3]!), p),
      minus(pointOf(points, corners[(i + 3) & 3]!), p),
    );
    const side = dot(normal, minus(inner, p)) < 0 ? -1 : 1;
    const height = side * dot(normal, minus(ray.origin, p));
    const rate = side * dot(normal, ray.direction);
    if (rate > 0) from = Math.max(from, -height / rate);
    else if (rate < 0) to = Math.min(to, -height / rate);
    else if (height < 0) return null;
    if (from >= to) return null;
  }
  return {from, to};
}

type Vector4 = [number, number, number, number];

/** Two directions perpendicular to the given one and to each other. */
export function sideways(direction: Vector): [Vector, Vector] {
  const smallest = [0, 1, 2].sort((a, b) => Math.abs(direction[a]!) - Math.abs(direction[b]!))[0]!;
  const axis: Vector = [0, 0, 0];
  axis[smallest] = 1;
  const across = cross(direction, axis);
  return [across, cross(direction, across)];
}
