// Where most values of a field lie.

import type {FieldScale} from './field_scale';

/** The shares of the values below and above the middle ones. */
const kTail = 0.02;
/** If the middle values take less of the range, the tails hide them. */
const kMinMiddle = 0.4;

/**
 * The 2nd and the 98th percentile of the values that occur in these cells, in [0, 1] as the scale's
 * values; [0, 1] without values. Each vertex, or cell of a cell field, counts once.
 */
export function middleOf(scale: FieldScale, tetrahedra: Uint32Array): [number, number] {
  const values = scale.occurring(tetrahedra).sort();
  const {length} = values;
  const at = (share: number): number => values[Math.round(share * (length - 1))]!;
  return length === 0 ? [0, 1] : [at(kTail), at(1 - kTail)];
}

/** A few values would take most of the colours of a range from `low` to `high`. */
export function tailsHide([from, to]: [number, number], [low, high]: [number, number]): boolean {
  return from < to && to - from < kMinMiddle * (high - low);
}
