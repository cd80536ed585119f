// Decides which cells are shown whole: those within a threshold of a field, and those that reach
// below every plane ("crinkle" clipping).

import type {Plane} from '../protocol/geometry';
import type {FieldScale} from './field_scale';
import {planeDistances} from './slice';

/**
 * Clears `kept` for cells with a value outside [low, high] or a missing one, at a corner or for the
 * cell. The bounds are in [0, 1], as `scale` gives values.
 */
export function keepWithin(
  kept: Uint8Array,
  tetrahedra: Uint32Array,
  scale: FieldScale,
  low: number,
  high: number,
): void {
  const inside = new Uint8Array(scale.size);
  for (let i = 0; i < inside.length; ++i) {
    const value = scale.at(i);
    inside[i] = value >= low && value <= high ? 1 : 0;
  }
  for (let cell = 0, at = 0; cell < kept.length; ++cell, at += 4) {
    kept[cell]! &= scale.ofCells
      ? inside[cell]!
      : inside[tetrahedra[at]!]! &
        inside[tetrahedra[at + 1]!]! &
        inside[tetrahedra[at + 2]!]! &
        inside[tetrahedra[at + 3]!]!;
  }
}

/** Clears `kept` for cells whose corners all lie above the plane. */
export function keepBelow(
  kept: Uint8Array,
  points: Int32Array,
  tetrahedra: Uint32Array,
  plane: Plane,
): void {
  const distances = planeDistances(points, plane);
  for (let cell = 0, at = 0; cell < kept.length; ++cell, at += 4) {
    const above =
      distances[tetrahedra[at]!]! >= 0 &&
      distances[tetrahedra[at + 1]!]! >= 0 &&
      distances[tetrahedra[at + 2]!]! >= 0 &&
      distances[tetrahedra[at + 3]!]! >= 0;
    if (above) kept[cell] = 0;
  }
}
