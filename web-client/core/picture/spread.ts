// Where most values of a field lie, and how much of the volume has them.

import type {MeshArrays} from './display';
import type {FieldScale} from './field_scale';

/** The shares of the volume with values below and above the middle ones. */
const kTail = 0.02;
/** If the middle values take less of the range, the tails hide them. */
const kMinMiddle = 0.7;
/** A value is searched for in so many parts of a span, then in those of one part, and so on. */
const kParts = 1024;
const kSearches = 3;

/** Fine enough for the knots of a transfer function. */
const kAmounts = 64;

/**
 * The ends of the values of the middle 96 % of the volume of these cells. They are in `extent` as
 * the scale's values; `extent` without values. A vertex has a quarter of each of its cells.
 */
export function middleOf(
  scale: FieldScale,
  {points, tetrahedra}: Pick<MeshArrays, 'points' | 'tetrahedra'>,
  extent: [number, number] = [0, 1],
): [number, number] {
  const volumes = new Float64Array(scale.size);
  for (let at = 0; at < tetrahedra.length; at += 4) {
    const volume = volumeOf(points, tetrahedra, at);
    if (scale.ofCells) volumes[at / 4] = volume;
    else for (let i = at; i < at + 4; ++i) volumes[tetrahedra[i]!]! += volume / 4;
  }
  const values = Float64Array.from(volumes, (volume, i) => (volume > 0 ? scale.at(i) : NaN));
  const total = volumes.reduce((sum, its, i) => (Number.isNaN(values[i]) ? sum : sum + its), 0);
  if (total === 0) return extent;
  return [
    valueBehind(values, volumes, kTail * total, extent),
    valueBehind(values, volumes, (1 - kTail) * total, extent),
  ];
}

/** The least of the `values` that has more than `rest` of the volumes up to it. */
function valueBehind(
  values: Float64Array,
  volumes: Float64Array,
  rest: number,
  extent: [number, number],
): number {
  let low = extent[0];
  let span = extent[1] - low;
  for (let search = 0; search < kSearches; ++search) {
    const parts = new Float64Array(kParts);
    values.forEach((value, i) => {
      const part = Math.min(kParts - 1, Math.floor(((value - low) / span) * kParts));
      if (part >= 0 && value <= low + span) parts[part]! += volumes[i]!;
    });
    let part = 0;
    while (part < kParts - 1 && parts[part]! <= rest) rest -= parts[part++]!;
    span /= kParts;
    low += part * span;
  }
  return low + span / 2;
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
