// The figures of the base mesh that the opening view needs.

import type {MeshArrays} from './display';
import {pointBounds} from './triangle_soup';

export interface BaseFigures {
  /** As Snapshot.bounds. */
  bounds: number[];
  /** The mean length of straight lines through the mesh, as a share of the bounds' diagonal. */
  chord: number;
}

/** REQUIRES: at least one cell. */
export function baseFigures(mesh: MeshArrays): BaseFigures {
  const bounds = pointBounds(mesh.points, mesh.boundary);
  const extents = [0, 1, 2].map((axis) => bounds[axis + 3]! - bounds[axis]!);
  return {
    bounds,
    chord: meanChord(mesh) / Math.max(Math.hypot(...extents), 1),
  };
}

/** Four volumes over the surface: exact for convex bodies (Cauchy), less for others. */
function meanChord({points, tetrahedra, boundary}: MeshArrays): number {
  let volume = 0;
  for (let at = 0; at < tetrahedra.length; at += 4) {
    const [a, b, c] = edgesFrom(points, tetrahedra, at, 3);
    volume += Math.abs(dot(a!, cross(b!, c!))) / 6;
  }
  let surface = 0;
  for (let at = 0; at < boundary.length; at += 3) {
    const [a, b] = edgesFrom(points, boundary, at, 2);
    surface += Math.hypot(...cross(a!, b!)) / 2;
  }
  return surface > 0 ? (4 * volume) / surface : 0;
}

function edgesFrom(
  points: Int32Array,
  corners: Uint32Array,
  at: number,
  count: number,
): [number, number, number][] {
  const from = 3 * corners[at]!;
  return Array.from({length: count}, (_, i) => {
    const to = 3 * corners[at + i + 1]!;
    return [0, 1, 2].map((axis) => points[to + axis]! - points[from + axis]!) as [
      number,
      number,
      number,
    ];
  });
}

const dot = (a: readonly number[], b: readonly number[]): number =>
  a[0]! * b[0]! + a[1]! * b[1]! + a[2]! * b[2]!;
const cross = (a: readonly number[], b: readonly number[]): number[] => [
  a[1]! * b[2]! - a[2]! * b[1]!,
  a[2]! * b[0]! - a[0]! * b[2]!,
  a[0]! * b[1]! - a[1]! * b[0]!,
];
