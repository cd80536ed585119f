// How the values of a field are spread: where most of them lie, and how much they tell apart.

import type {MeshArrays} from './display';
import {kMagnitude, type FieldScale} from './field_scale';

/** A colour map's entries: more differences cannot be seen. */
const kBins = 256;
/** The shares of the values below and above the middle ones. */
const kTail = 0.02;

export interface Spread {
  /** The 2nd and the 98th percentile, in [0, 1] as the scale's values; [0, 1] without values. */
  middle: [number, number];
  /** Shannon's entropy of 256 equal bins from the least value to the greatest, in bits. */
  entropy: number;
}

/**
 * The spread of the values that occur in these cells. Each vertex, or cell of a cell field, counts
 * once.
 */
export function spreadOf(scale: FieldScale, tetrahedra: Uint32Array): Spread {
  const values = scale.occurring(tetrahedra).sort();
  const {length} = values;
  if (length === 0) return {middle: [0, 1], entropy: 0};
  const low = values[0]!;
  const span = values[length - 1]! - low;
  const at = (share: number): number => values[Math.round(share * (length - 1))]!;
  if (!(span > 0)) return {middle: [low, low], entropy: 0};
  const counts = new Uint32Array(kBins);
  for (const value of values)
    ++counts[Math.min(kBins - 1, Math.floor((kBins * (value - low)) / span))]!;
  let entropy = 0;
  for (const count of counts)
    if (count > 0) entropy -= (count / length) * Math.log2(count / length);
  return {middle: [at(kTail), at(1 - kTail)], entropy};
}

/** The field among these whose values have most entropy; the first one of equals, 0 of none. */
export function fieldOfMaxContrast(mesh: MeshArrays, fields: readonly number[]): number {
  let best = {field: fields[0] ?? 0, entropy: -1};
  if (fields.length < 2) return best.field;
  for (const field of fields) {
    const scale = mesh.scale({field, component: kMagnitude});
    const entropy = scale ? spreadOf(scale, mesh.tetrahedra).entropy : -1;
    if (entropy > best.entropy) best = {field, entropy};
  }
  return best.field;
}
