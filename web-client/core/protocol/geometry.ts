// Places in lattice coordinates.

export type Vector = [number, number, number];

export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/**
 * The points with normal . p = offset. The part above (normal . p > offset) is cut away.
 */
export interface Plane {
  normal: [number, number, number];
  offset: number;
}
