// Whether a corner of the picture is free of the mesh.

import type {Point} from '../page/card_place';

/** So many directions part a rectangle from points, or count it as covered. */
const kDirections = 64;

export interface Rectangle {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/** A straight line parts the rectangle from all points, so that nothing between them covers it. */
export function isFree({left, right, top, bottom}: Rectangle, points: readonly Point[]): boolean {
  const corners = [left, right].flatMap((x) => [top, bottom].map((y) => ({x, y})));
  return Array.from({length: kDirections}, (_, i) => (2 * Math.PI * i) / kDirections).some(
    (angle) => {
      const along = ({x, y}: Point): number => x * Math.cos(angle) + y * Math.sin(angle);
      return Math.max(...corners.map(along)) < Math.min(...points.map(along));
    },
  );
}
