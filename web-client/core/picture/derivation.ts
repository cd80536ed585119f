// The part of core/derived for pictures, once it is loaded.

import type {Manifest} from '../protocol/manifest';
import type {RestMesh, ShownDerived, ValuesOf} from './derived_field';
import type {Display, MeshArrays} from './display';
import type {FieldScale, Scalar} from './field_scale';

/** A derived colour in a picture. */
export interface DerivedColor {
  /** The part of scalarRange that occurs. */
  extent: [number, number];
  /** The extent of all pictures of a series so far, which `extent` is, too. */
  ofSeries: [number, number] | undefined;
  made: {derivedId: number; inputs: readonly number[]};
}

/** The colour of the last picture. */
export interface Drawn {
  color: Scalar | null;
  inputs?: readonly number[];
}

/** It computes, and is loaded with the first derived field. */
export const derivation: {
  scale?: (
    field: ShownDerived['fields'][number],
    valuesOf: ValuesOf,
    mesh: RestMesh,
  ) => FieldScale | null;
  /** Undefined: the colour is no derived one. */
  color?: (
    mesh: MeshArrays,
    display: Display,
    scale: FieldScale,
    manifest: Manifest,
  ) => DerivedColor | undefined;
  /** The pairs of a field that a derived colour is made of, and the one in its last picture. */
  inputs?: (wanted: Display, drawn: Drawn) => [number, number][];
  /** The display with the fields of the last picture, if it has the same derived colour. */
  held?: (wanted: Display, drawn: Drawn) => Display;
} = {};
