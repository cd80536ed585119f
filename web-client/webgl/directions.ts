// The standard views, named by the axis that the camera looks from.

export const kDirections = ['+x', '-x', '+y', '-y', '+z', '-z'] as const;
export type Direction = (typeof kDirections)[number];

/** Throws a TypeError unless it is a standard view or null. */
export function checkedDirection(direction: unknown): Direction | null {
  const known = [null, ...kDirections].find((one) => one === direction);
  if (known !== undefined) return known;
  throw new TypeError(
    `There is no view from "${String(direction)}"; there are ${kDirections.join(', ')} and ` +
      'null, the first one.',
  );
}
