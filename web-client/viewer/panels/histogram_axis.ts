// The axis of the histogram, and its two handles, as numbers.

import {kBars, type Axis} from '../../core/picture/histogram';
import {placeOn, valueAt} from '../../core/picture/log_scale';
import {roundTo} from '../page/format';
import type {ShownRange} from '../settings/settings';

/** The handles stay so far apart, as a share of the axis: a range needs a width. */
export const kMinApart = 1 / 200;
/** A value that a handle writes is as fine as this share of the axis, which is below a pixel. */
const kFine = 1e-4;
export type End = 0 | 1;

/** All values that occur and both ends of the range, as far as a logarithm has them. */
export function axisOf(range: ShownRange, extent: readonly [number, number]): Axis {
  const {logarithmic} = range;
  const from = logarithmic && range.low > 0 && extent[0] <= 0 ? range.low : extent[0];
  return {low: Math.min(from, range.low), high: Math.max(extent[1], range.high), logarithmic};
}

/** The value's place on the axis, in [0, 1]. */
export function shareOf(axis: Axis, value: number): number {
  const {low, high, logarithmic} = axis;
  if (!(low < high)) return 0.5;
  if (logarithmic && low > 0 && value <= 0) return 0;
  return Math.min(1, Math.max(0, placeOn(axis, value)));
}

/** The range with one end moved to `share`, below or above the other end. */
export function movedRange(
  axis: Axis,
  range: readonly [number, number],
  end: End,
  share: number,
): [number, number] {
  const other = shareOf(axis, range[1 - end]!);
  const place = end === 0 ? Math.min(share, other - kMinApart) : Math.max(share, other + kMinApart);
  const value = valueAt(axis, Math.min(1, Math.max(0, place)));
  // Decades below the axis' end have digits of their own.
  const fine = kFine * (axis.logarithmic ? Math.abs(value) : axis.high - axis.low);
  const moved = roundTo(value, fine);
  const next: [number, number] = end === 0 ? [moved, range[1]] : [range[0], moved];
  return next[0] < next[1] ? next : [range[0], range[1]];
}

/** The end that a pointer at `share` takes: the nearer one, else that on its side. */
export function nearestEnd(axis: Axis, range: readonly [number, number], share: number): End {
  const [low, high] = range.map((value) => shareOf(axis, value)) as [number, number];
  return Math.abs(share - high) < Math.abs(share - low) || (low === high && share > low) ? 1 : 0;
}

/**
 * Heights in [0, 1], as the square roots of the counts: one bar hides no others. A bar that holds
 * anything is seen.
 */
export function heightsOf(counts: readonly number[]): number[] {
  const kLowest = 0.03;
  const max = Math.max(...counts);
  return counts.map((count) => (count > 0 ? Math.max(kLowest, Math.sqrt(count / max)) : 0));
}

/** The outline of the bars for SVG: each is one wide, and 1 high at most. */
export function barsPath(counts: readonly number[]): string {
  return heightsOf(counts)
    .map((height, i) => (height > 0 ? `M${i} 1V${(1 - height).toFixed(3)}h.86V1z` : ''))
    .join('');
}

export const kViewBox = `0 0 ${kBars} 1`;
