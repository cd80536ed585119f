// Streamlines as displays and pictures have them.

import type {Vector} from '../protocol/geometry';

/** Where lines begin, on the lattice. */
export type Seeds =
  /** So many lines, evenly spaced. */
  | {kind: 'even'; count: number}
  | {kind: 'line'; from: Vector; to: Vector; count: number}
  /** A square grid over the box of the mesh, `count` along its longer side. */
  | {kind: 'plane'; normal: Vector; offset: number; count: number}
  | {kind: 'sphere'; centre: Vector; radius: number; count: number};

export interface LineLimits {
  /** In each direction. */
  steps: number;
  /** A share of the diagonal of the mesh's box. */
  length: number;
  /** In the unit that vectors times it are lengths; Infinity: none. */
  time: number;
}

/** An instant of the vectors. */
export interface LineInstant {
  field: number;
  time: number;
}

export interface StreamlinesRequest {
  /** A field of points with three components. */
  field: number;
  /** Lines go through these, by ascending time, and `field` is one of them; absent: through one. */
  instants?: readonly LineInstant[];
  seeds: readonly Seeds[];
  limits: LineLimits;
}

/** Numbers of a point: x, y and z on the lattice, its value, its time, and its line's number. */
export const kLineWidth = 6;

/** Points one after another, with a segment between each two of a line. */
export interface LineSoup {
  /** The value is NaN if it is missing, or without a colour. */
  points: Float32Array;
  /** How many lines there are. */
  lines: number;
  /** In the fastest place: the time of a way as long as the diagonal of the mesh's box. */
  crossing: number;
  /** There would be more, or longer ones: a limit of the whole was reached. */
  isCut: boolean;
}
