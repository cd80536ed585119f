// The figures of the base mesh that the opening view needs.

import type {MeshArrays} from './display';
import {pointBounds} from './triangle_soup';

export interface BaseFigures {
  /** As Snapshot.bounds. */
  bounds: number[];
  /** The mean length of straight lines through the mesh, as a share of the bounds' diagonal. */
  chord: number;
  /**
   * Bounds of the place where the cells are small, if the rest dwarfs it; else null. A far field
   * has few large cells.
   */
  focus: number[] | null;
}

/** The share of the cells on each side, along each axis, that `focus` leaves out. */
const kOutside = 0.1;
/** A focus is reported if it is this much smaller than the bounds. */
const kDwarfed = 0.25;
/** It gets this much room round it, of its own extent on each side. */
const kRoom = 0.25;

/** REQUIRES: at least one cell. */
export function baseFigures(mesh: MeshArrays): BaseFigures {
  const bounds = pointBounds(mesh.points, mesh.boundary);
  const extents = [0, 1, 2].map((axis) => bounds[axis + 3]! - bounds[axis]!);
  return {
    bounds,
    chord: meanChord(mesh) / Math.max(Math.hypot(...extents), 1),
    focus: focusOf(mesh, Math.max(...extents)),
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

function focusOf({points, tetrahedra}: MeshArrays, largest: number): number[] | null {
  const sides = [0, 1, 2].map((axis) => {
    const middles: number[] = [];
    for (let at = 0; at < tetrahedra.length; at += 4) {
      if (tetrahedra[at] === tetrahedra[at + 1]) continue; // a hole
      let sum = 0;
      for (let i = at; i < at + 4; ++i) sum += points[3 * tetrahedra[i]! + axis]!;
      middles.push(sum / 4);
    }
    const sorted = Float64Array.from(middles).sort();
    const place = (share: number): number => sorted[Math.round(share * (sorted.length - 1))]!;
    return [place(kOutside), place(1 - kOutside)] as const;
  });
  const extent = Math.max(...sides.map(([low, high]) => high - low));
  if (!(extent > 0) || extent > kDwarfed * largest) return null;
  return [
    ...sides.map(([low]) => low - kRoom * extent),
    ...sides.map(([, high]) => high + kRoom * extent),
  ];
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
