// The points that are kept, as an attribute says them: places of the mesh at rest, in its own
// coordinates.

import {parseNumbers} from '../../core/layers/field_values';
import type {Vector} from '../../core/protocol/geometry';

/** Each has a colour of its own. */
export const kMaxPoints = 8;
/** A georeferenced mesh has millions of metres. */
const kDigits = 10;

/** "1,2,0.5 3,2,0"; null if it is something else, or more. */
export function parsePoints(text: string): Vector[] | null {
  const words = text.trim().split(/\s+/).filter(Boolean);
  const points = words.map((word) => parseNumbers(word));
  const areRight = points.every((point) => point.length === 3);
  return areRight && points.length <= kMaxPoints ? (points as Vector[]) : null;
}

/** Null: there is none. */
export const pointsText = (points: readonly Vector[]): string | null =>
  points.length === 0
    ? null
    : points
        .map((point) => point.map((x) => String(Number(x.toPrecision(kDigits)))).join())
        .join(' ');
