// The lines of sight through a canvas, in lattice coordinates, for shaders. They begin at the near
// plane. The eye of a parallel view is a thousand times as far away as the mesh is large. Single
// floats relative to it would be wrong.

import type {Vector} from '../core/protocol/geometry';
import type {Matrix} from './matrix';

export interface Rays {
  /** The middle of the near plane, and the ways from there to its right and its upper end. */
  near: Vector[];
  far: Vector[];
  /** The homogeneous coordinate w at the far plane, divided by that at the near plane. */
  farPerNear: number;
  /** The distances of the two planes from the eye, in radii of the mesh. */
  distances: [number, number];
}

export function raysOf(fromCanvas: Matrix): Rays {
  // the same for all x and y: the planes are parallel to the canvas
  const w = (z: number): number => fromCanvas[11]! * z + fromCanvas[15]!;
  const column = (k: number): Vector => [
    fromCanvas[4 * k]!,
    fromCanvas[4 * k + 1]!,
    fromCanvas[4 * k + 2]!,
  ];
  const [x, y, z, middle] = [0, 1, 2, 3].map(column) as [Vector, Vector, Vector, Vector];
  const plane = (at: number): Vector[] =>
    [middle.map((value, axis) => value + at * z[axis]!), x, y].map(
      (vector) => vector.map((value) => value / w(at)) as Vector,
    );
  return {
    near: plane(-1),
    far: plane(1),
    farPerNear: w(1) / w(-1),
    distances: [1 / w(-1), 1 / w(1)],
  };
}
