// Logarithmic scales. With values of both signs, or below 0, a scale is linear about 0 and
// logarithmic on both sides of that (J. B. W. Webber, "A bi-symmetric log transformation for
// wide-range data", Meas. Sci. Technol. 24, 2013). The slope is continuous.

/** The linear part reaches this share of the larger end: three decades on each side. */
const kLinearShare = 1e-3;

/** A scale from `low` to `high`. REQUIRES: low < high, and low is not 0 if `logarithmic`. */
export interface Scale {
  low: number;
  high: number;
  logarithmic: boolean;
}

/** Where the linear part about 0 ends; 0 if there is none. */
export function linearPart({low, high, logarithmic}: Scale): number {
  return logarithmic && low < 0 ? kLinearShare * Math.max(-low, high) : 0;
}

/** The value's place on the scale, in [0, 1] if it lies inside; NaN or -Infinity if it has none. */
export function placeOn(scale: Scale, value: number): number {
  const bend = bendOf(scale);
  const [from, to] = [bend(scale.low), bend(scale.high)];
  return (bend(value) - from) / (to - from);
}

/** The value at a place. */
export function valueAt(scale: Scale, place: number): number {
  const {low, high, logarithmic} = scale;
  if (place <= 0) return low;
  if (place >= 1) return high;
  const bend = bendOf(scale);
  const bent = bend(low) + place * (bend(high) - bend(low));
  const linear = linearPart(scale);
  if (!logarithmic) return bent;
  if (linear === 0) return Math.exp(bent);
  return Math.abs(bent) <= 1
    ? linear * bent
    : Math.sign(bent) * linear * Math.exp(Math.abs(bent) - 1);
}

/** Shaders do the same (field_shaders.ts, ray_shaders.ts). */
function bendOf(scale: Scale): (value: number) => number {
  if (!scale.logarithmic) return (value) => value;
  const linear = linearPart(scale);
  if (linear === 0) return Math.log;
  return (value) => {
    const size = Math.abs(value) / linear;
    return Math.sign(value) * (size <= 1 ? size : 1 + Math.log(size));
  };
}

/** GLSL: `bend` of a value. `linear` is linearPart. Without a logarithm it is `least`'s. */
export const kBendShader = /* glsl */ `
  float bend(float value, float linear, float least) {
    if (linear == 0.0) return log(value > 0.0 ? value : least);
    float size = abs(value) / linear;
    return sign(value) * (size <= 1.0 ? size : 1.0 + log(size));
  }`;
