// The standard views, by the axis that the camera looks from.

export const kDirections = ['+x', '-x', '+y', '-y', '+z', '-z'] as const;
export type Direction = (typeof kDirections)[number];

/** Throws a TypeError for anything but a standard view or null. */
export function checkedDirection(direction: Direction | null): Direction | null {
  if (direction === null || kDirections.includes(direction)) return direction;
  throw new TypeError(
    `There is no view from "${String(direction)}"; there are ${kDirections.join(', ')} and ` +
      'null, the first one.',
  );
}
