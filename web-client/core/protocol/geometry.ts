// Places in lattice coordinates, and in those of the input.

export type Vector = [number, number, number];

export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** The place in the input's own coordinates. */
export const positionOf = ({origin, step}: {origin: Vector; step: number}, place: Vector): Vector =>
  place.map((x, axis) => origin[axis]! + step * x) as Vector;

/** The inverse: the place on the lattice. */
export const placeOf = ({origin, step}: {origin: Vector; step: number}, position: Vector): Vector =>
  position.map((x, axis) => (x - origin[axis]!) / step) as Vector;

/** The way from places of one lattice to those of another: factor * place + offset. */
export interface LatticeChange {
  factor: number;
  offset: Vector;
}

type Lattice = Parameters<typeof positionOf>[0];

export const latticeChange = (from: Lattice, to: Lattice): LatticeChange => ({
  factor: from.step / to.step,
  offset: from.origin.map((x, axis) => (x - to.origin[axis]!) / to.step) as Vector,
});

/** The place on the other lattice. */
export const moved = ({factor, offset}: LatticeChange, place: readonly number[]): Vector =>
  place.map((x, axis) => factor * x + offset[axis]!) as Vector;

/**
 * The points with normal . p = offset. The part above (normal . p > offset) is cut away.
 */
export interface Plane {
  normal: [number, number, number];
  offset: number;
}

/** The lengths of a box, [x0, y0, z0, x1, y1, z1], along the axes. */
export const sidesOf = (bounds: readonly number[]): number[] =>
  [0, 1, 2].map((axis) => bounds[axis + 3]! - bounds[axis]!);
