// Fields of labels: few whole numbers, such as materials or parts. They get colours of their own.

import type {FieldInfo} from '../protocol/fields';

/** So many colours can be told apart in a picture, and so many are in the map `labels`. */
export const kMaxLabels = 20;

/** The first label and how many there are; null if the field holds no labels. */
export function labelsOf({components, isWhole, range}: FieldInfo): [number, number] | null {
  const count = range[1] - range[0] + 1;
  const areFew = components === 1 && isWhole && count >= 2 && count <= kMaxLabels;
  return areFew && Number.isInteger(range[0]) ? [range[0], count] : null;
}
