// Counts a field's values for the colour panel.

import {scalarRange, type FieldScale, type Scalar} from './field_scale';
import {placeOn} from './log_scale';
import type {FieldInfo} from '../protocol/fields';

/** As many as the panel has room for: each is 4 to 5 pixels wide. */
export const kBars = 56;
/** The share of the values below and above the middle 98 %. */
const kTail = 0.01;

/** The values that the bars span. */
export interface Axis {
  low: number;
  high: number;
  logarithmic: boolean;
}

export interface Histogram {
  /** The values in each part of the axis; those outside count nowhere. */
  counts: number[];
  /** Each vertex, or cell of a cell field, counts once; missing values do not. */
  total: number;
  /** The lowest and the highest value; null without values. */
  extent: [number, number] | null;
  /** The middle 98 % of the values lie here. */
  middle: [number, number] | null;
}

/** Counts the values of these cells. REQUIRES: `scale` is that of the scalar of `info`. */
export function histogramOf(
  scale: FieldScale,
  tetrahedra: Uint32Array,
  info: FieldInfo,
  {component}: Scalar,
  axis: Axis,
): Histogram {
  const [low, high] = scalarRange(info, component);
  const values = scale
    .occurring(tetrahedra)
    .map((share) => low + share * (high - low))
    .sort();
  const at = (share: number): number => values[Math.round(share * (values.length - 1))]!;
  const isEmpty = values.length === 0;
  return {
    counts: countsOf(values, axis),
    total: values.length,
    extent: isEmpty ? null : [at(0), at(1)],
    middle: isEmpty ? null : [at(kTail), at(1 - kTail)],
  };
}

/** The last part holds its end. An axis without width has all its values in the middle part. */
export function countsOf(values: Float64Array, axis: Axis): number[] {
  const {low, high, logarithmic} = axis;
  const counts = new Array<number>(kBars).fill(0);
  for (const value of values) {
    if (logarithmic && low > 0 && value <= 0) continue;
    const place = low < high ? placeOn(axis, value) : value === low ? 0.5 : -1;
    if (place >= 0 && place <= 1) ++counts[Math.min(kBars - 1, Math.floor(kBars * place))]!;
  }
  return counts;
}
