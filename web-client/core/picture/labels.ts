// Fields of labels: whole numbers that say what a cell is, such as materials or parts. They get
// colours of their own. The log says which fields are labels. Without a word of it, few whole
// numbers count as such.

import type {FieldInfo} from '../protocol/fields';
import {kLabelColors} from './color_maps';
import {FieldScale, kMagnitude, scalarRange} from './field_scale';

/** So many whole numbers count as labels without a word of the log. */
export const kMaxLabels = 20;
/** So many labels are listed beside a picture. */
export const kListedLabels = 12;

/** The labels that a mesh has, ascending: the first ones, and how many there are. */
export interface ShownLabels {
  values: number[];
  count: number;
}

/**
 * The first label and how many there are; null if the field holds no labels. A label of the log has
 * the colours of its numbers, from 0 on.
 */
export function labelsOf({components, isWhole, labels, range}: FieldInfo): [number, number] | null {
  if (labels) return [0, kLabelColors];
  const count = range[1] - range[0] + 1;
  const areFew = components === 1 && isWhole && count >= 2 && count <= kMaxLabels;
  return areFew && Number.isInteger(range[0]) ? [range[0], count] : null;
}

/** The number in [0, kLabelColors) of a label's colour. So a label has it in every log. */
export function labelColorOf(label: number): number {
  return ((label % kLabelColors) + kLabelColors) % kLabelColors;
}

/** The values that 0 and 1 stand for in LabelScale. */
export const kLabelScaleRange: [number, number] = [0, kLabelColors - 1];

/** A label's colours instead of its values. They need exact numbers, which shaders lack. */
export class LabelScale extends FieldScale {
  private readonly first: number;
  private readonly span: number;

  constructor(values: Int32Array, info: FieldInfo) {
    super(values, info);
    const [low, high] = scalarRange(info, kMagnitude);
    this.first = low;
    this.span = high - low;
  }

  override at(index: number): number {
    const label = Math.round(this.first + this.span * super.at(index));
    return labelColorOf(label) / kLabelScaleRange[1];
  }
}

/** The labels of these cells. */
export function shownLabels(
  scale: FieldScale,
  tetrahedra: Uint32Array,
  {range: [low, high]}: FieldInfo,
): ShownLabels {
  const shares = new Set<number>();
  let last = NaN;
  for (const share of scale.occurring(tetrahedra)) {
    if (share !== last) shares.add(share); // neighbours are often alike
    last = share;
  }
  const all = [...shares].map((share) => Math.round(low + (high - low) * share));
  const values = [...new Set(all)].sort((a, b) => a - b);
  return {values: values.slice(0, kListedLabels), count: values.length};
}
