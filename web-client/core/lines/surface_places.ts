// Places on a surface, evenly spaced: in each cube of a grid the one that is nearest to its middle.
// So they stay nearly where they are while a mesh refines.

import {minus} from '../picture/cell_value';
import {cross, dot, type Vector} from '../protocol/geometry';

export interface CellPlace {
  cell: number;
  place: Vector;
  /** Away from what is drawn; absent: both sides are free. */
  outward?: Vector;
}

interface Mesh {
  points: Int32Array;
  tetrahedra: Uint32Array;
}

/** Each of `faces` is 4 * cell + the opposite corner. */
export function placesOnFaces(mesh: Mesh, faces: Uint32Array, spacing: number): CellPlace[] {
  const nearest = new Map<number, CellPlace & {distance: number}>();
  const corners: [Vector, Vector, Vector] = [
    [0, 0, 0],
    [0, 0, 0],
    [0, 0, 0],
  ];
  for (const face of faces) {
    takeCorners(mesh, face, corners);
    const [from, to] = cubesOf(corners, spacing);
    const sizes = from.map((low, axis) => to[axis]! - low + 1);
    const count = sizes[0]! * sizes[1]! * sizes[2]!;
    for (let i = 0; i < count; ++i) {
      const x = from[0] + (i % sizes[0]!);
      const y = from[1] + (Math.trunc(i / sizes[0]!) % sizes[1]!);
      const z = from[2] + Math.trunc(i / (sizes[0]! * sizes[1]!));
      const middle: Vector = [(x + 0.5) * spacing, (y + 0.5) * spacing, (z + 0.5) * spacing];
      const place = nearestOn(corners, middle);
      const isIn = place.every((at, axis) => Math.abs(at - middle[axis]!) <= spacing / 2);
      if (!isIn) continue;
      const key = (z * kCubes + y) * kCubes + x;
      const distance = squared(place, middle);
      if (distance < (nearest.get(key)?.distance ?? Infinity))
        nearest.set(key, {
          cell: face >> 2,
          place,
          outward: outwardOf(mesh, face, corners),
          distance,
        });
    }
  }
  return [...nearest.keys()].sort((a, b) => a - b).map((key) => nearest.get(key)!);
}

/** More than there are along an axis. */
const kCubes = 4096;

function takeCorners({points, tetrahedra}: Mesh, face: number, corners: Vector[]): void {
  for (let k = 0; k < 3; ++k) {
    const vertex = 3 * tetrahedra[(face & ~3) + ((face + 1 + k) & 3)]!;
    const corner = corners[k]!;
    for (let axis = 0; axis < 3; ++axis) corner[axis] = points[vertex + axis]!;
  }
}

function outwardOf(
  {points, tetrahedra}: Mesh,
  face: number,
  [a, b, c]: readonly [Vector, Vector, Vector],
): Vector {
  const normal = cross(minus(b, a), minus(c, a));
  const inner = 3 * tetrahedra[face]!;
  const inwards = minus([points[inner]!, points[inner + 1]!, points[inner + 2]!], a);
  return dot(normal, inwards) > 0 ? (normal.map((x) => -x) as Vector) : normal;
}

function cubesOf([a, b, c]: [Vector, Vector, Vector], spacing: number): [Vector, Vector] {
  const at = (x: number): number => Math.floor(x / spacing);
  return [
    [0, 1, 2].map((i) => at(Math.min(a[i]!, b[i]!, c[i]!))) as Vector,
    [0, 1, 2].map((i) => at(Math.max(a[i]!, b[i]!, c[i]!))) as Vector,
  ];
}

const squared = (a: Vector, b: Vector): number =>
  (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2;
const plus = (a: Vector, s: number, u: Vector, t = 0, v: Vector = u): Vector => [
  a[0] + s * u[0] + t * v[0],
  a[1] + s * u[1] + t * v[1],
  a[2] + s * u[2] + t * v[2],
];

/** The place of a triangle nearest to a point (Ericson, "Real-Time Collision Detection"). */
function nearestOn([a, b, c]: readonly [Vector, Vector, Vector], p: Vector): Vector {
  const [ab, ac, ap] = [minus(b, a), minus(c, a), minus(p, a)];
  const [d1, d2] = [dot(ab, ap), dot(ac, ap)];
  if (d1 <= 0 && d2 <= 0) return [...a];
  const bp = minus(p, b);
  const [d3, d4] = [dot(ab, bp), dot(ac, bp)];
  if (d3 >= 0 && d4 <= d3) return [...b];
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return plus(a, d1 / (d1 - d3), ab);
  const cp = minus(p, c);
  const [d5, d6] = [dot(ab, cp), dot(ac, cp)];
  if (d6 >= 0 && d5 <= d6) return [...c];
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return plus(a, d2 / (d2 - d6), ac);
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return plus(b, (d4 - d3) / (d4 - d3 + d5 - d6), minus(c, b));
  const sum = va + vb + vc;
  return sum > 0 ? plus(a, vb / sum, ab, vc / sum, ac) : [...a];
}
