// How the parts of a mesh are drawn: the cells of each value of a label.

import type {Scalar} from './field_scale';

/** Labels stand for the parts. */
export interface PartsRequest {
  /** The label: a field of cells. */
  scalar: Scalar;
  /** FieldInfo.range of it. */
  range: readonly [number, number];
  hidden: readonly number[];
  /** The parts in `hidden` are the only ones that are not hidden. */
  isInverse: boolean;
  /** Below 1, by part. */
  opacities: readonly (readonly [label: number, opacity: number])[];
  /** From 0 to 255, by part. */
  colors: readonly (readonly [label: number, color: readonly number[]])[];
  /** It stands out; null: none does. */
  selected: number | null;
}
