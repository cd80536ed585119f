// The quantities of vectors at points that are made of gradients. Another one is a line in
// kFlowQuantities.

import type {FieldInfo} from '../protocol/fields';

export interface FlowQuantity {
  /** Behind the field's name and a point, in addresses and expressions. */
  name: string;
  title: string;
  /** The functions of the vector, the innermost first. */
  functions: readonly string[];
}

/** In the order of the menu. */
const kFlowQuantities: readonly FlowQuantity[] = [
  {name: 'div', title: 'divergence', functions: ['div']},
  {name: 'vorticity', title: 'vorticity', functions: ['curl', 'mag']},
  {name: 'Q', title: 'Q criterion', functions: ['Q']},
];

export const flowQuantitiesOf = ({association, components}: FieldInfo): readonly FlowQuantity[] =>
  association === 'point' && components === 3 ? kFlowQuantities : [];
