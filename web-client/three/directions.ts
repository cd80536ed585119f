// The standard views, by the axis that the camera looks from.

export const kDirections = ['+x', '-x', '+y', '-y', '+z', '-z'] as const;
export type Direction = (typeof kDirections)[number];
