// Places in a cell, and the value there. Layers need no more of cell_ray.ts.

import {cross, dot, type Vector} from '../protocol/geometry';
import type {FieldScale} from './field_scale';
import type {Cells} from './section';

/** origin + t * direction, in lattice coordinates. */
export interface Ray {
  origin: Vector;
  direction: Vector;
}

export function along({origin, direction}: Ray, t: number): Vector {
  return [origin[0] + t * direction[0], origin[1] + t * direction[1], origin[2] + t * direction[2]];
}

/** Barycentric coordinates of `point`: the shares of the four corners, which add up to 1. */
export function barycentric(
  {points, tetrahedra}: Cells,
  cell: number,
  point: Vector,
): [number, number, number, number] {
  const corners = [0, 1, 2, 3].map((i) => pointOf(points, tetrahedra[4 * cell + i]!)) as [
    Vector,
    Vector,
    Vector,
    Vector,
  ];
  const whole = volume(...corners);
  const share = (i: number): number =>
    volume(...(corners.map((corner, k) => (k === i ? point : corner)) as typeof corners)) / whole;
  return [share(0), share(1), share(2), share(3)];
}

/** The value at a point of the cell. */
export function valueAt(mesh: Cells, scale: FieldScale, cell: number, point: Vector): number {
  if (scale.ofCells) return scale.at(cell);
  const shares = barycentric(mesh, cell, point);
  return shares.reduce(
    (sum, share, i) => sum + share * scale.at(mesh.tetrahedra[4 * cell + i]!),
    0,
  );
}

export function pointOf(points: Int32Array, vertex: number): Vector {
  return [points[3 * vertex]!, points[3 * vertex + 1]!, points[3 * vertex + 2]!];
}
export function minus(a: Vector, b: Vector): Vector {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}
function volume(a: Vector, b: Vector, c: Vector, d: Vector): number {
  return dot(minus(b, a), cross(minus(c, a), minus(d, a)));
}
