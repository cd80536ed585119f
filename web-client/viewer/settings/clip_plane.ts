// Turns clip planes of the attributes, which stand at a share of the mesh's extent, into lattice
// planes.

import {axisOf, type ClipSetting} from '../../core/layers/clip';
import type {Plane} from '../../core/protocol/geometry';

/** The extent of the bounds along a normal, in lattice units. */
export function extentAlong(bounds: number[], normal: readonly number[]): [number, number] {
  let low = 0;
  let high = 0;
  for (let axis = 0; axis < 3; ++axis) {
    const a = normal[axis]! * bounds[axis]!,
      b = normal[axis]! * bounds[axis + 3]!;
    low += Math.min(a, b);
    high += Math.max(a, b);
  }
  return [low, high];
}

/**
 * The plane in lattice coordinates. A share counts upwards along an axis, whichever side is cut
 * away, and along the normal of a free plane.
 */
export function planeOf({normal, share}: ClipSetting, bounds: number[]): Plane {
  const [low, high] = extentAlong(bounds, normal);
  const {axis} = axisOf({normal, share});
  const upwards = axis < 0 || normal[axis]! > 0;
  // Between two lattice planes no vertex lies on the cut, and no cell's section is a single point.
  return {normal, offset: Math.floor(low + (upwards ? share : 1 - share) * (high - low)) + 0.5};
}
