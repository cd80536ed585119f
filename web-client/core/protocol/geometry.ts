// Places in lattice coordinates.

export type Vector = [number, number, number];

/**
 * The points with normal . p = offset. The part above (normal . p > offset) is cut away.
 */
export interface Plane {
  normal: [number, number, number];
  offset: number;
}
