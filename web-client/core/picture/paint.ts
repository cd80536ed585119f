// How a triangle is drawn, beside its field: four bytes a corner, for the shaders.

/** Red, green and blue of a colour of its own, and a code (kPaintShader). */
export type Paint = readonly [number, number, number, number];

/** The code of triangles that are drawn as others: solid, in the colours of the field. */
export const kPlainCode = 255;
const kOwnColor = 128;
const kSelected = 64;
/** Opacities have so many steps. One more would be kPlainCode. */
export const kOpacitySteps = 62;

export function paintOf(of: {
  color: readonly number[] | null;
  /** Above 0, at most 1. */
  opacity: number;
  isSelected: boolean;
}): Paint {
  const [red, green, blue] = of.color ?? [0, 0, 0];
  const opacity = Math.max(1, Math.round(of.opacity * kOpacitySteps));
  const code = (of.color ? kOwnColor : 0) + (of.isSelected ? kSelected : 0) + opacity;
  return [red!, green!, blue!, code === kOpacitySteps ? kPlainCode : code];
}

/** Some of a triangle's cell is seen through it. */
export const isClear = (code: number): boolean =>
  code !== kPlainCode && code % kSelected < kOpacitySteps;
