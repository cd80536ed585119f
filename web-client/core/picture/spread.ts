// Where most values of a field lie, and how much of the volume has them.

import type {MeshArrays} from './display';
import type {FieldScale} from './field_scale';

/** The shares of the values below and above the middle ones. */
const kTail = 0.02;
/** If the middle values take less of the range, the tails hide them. */
const kMinMiddle = 0.4;

/** Fine enough for the knots of a transfer function. */
const kAmounts = 64;

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

/**
 * The shares of the volume with values in kAmounts even parts of [0, 1]. A cell counts with its
 * mean value. Missing values do not count; without values all shares are 0.
 */
export function amountsOf(
  scale: FieldScale,
  {points, tetrahedra}: Pick<MeshArrays, 'points' | 'tetrahedra'>,
): number[] {
  const amounts = new Array<number>(kAmounts).fill(0);
  let sum = 0;
  for (let at = 0; at < tetrahedra.length; at += 4) {
    let value = 0;
    if (scale.ofCells) value = scale.at(at / 4);
    else for (let i = at; i < at + 4; ++i) value += scale.at(tetrahedra[i]!) / 4;
    const amount = volumeOf(points, tetrahedra, at);
    if (Number.isNaN(value) || amount === 0) continue;
    const part = Math.floor(value * kAmounts);
    amounts[Math.min(kAmounts - 1, Math.max(0, part))]! += amount;
    sum += amount;
  }
  return sum > 0 ? amounts.map((amount) => amount / sum) : amounts;
}

/** Six times the volume of the cell whose corners begin at `at`; 0 for a hole. */
function volumeOf(points: Int32Array, tetrahedra: Uint32Array, at: number): number {
  const from = 3 * tetrahedra[at]!;
  const side = (corner: number, axis: number): number =>
    points[3 * tetrahedra[at + corner]! + axis]! - points[from + axis]!;
  let volume = 0;
  for (let axis = 0; axis < 3; ++axis) {
    const [next, last] = [(axis + 1) % 3, (axis + 2) % 3];
    volume += side(1, axis) * (side(2, next) * side(3, last) - side(2, last) * side(3, next));
  }
  return Math.abs(volume);
}
