// Fields that are computed from the manifest's. They stand behind those, so that a display, menus
// and addresses name them like all others. core/derived makes and computes them, once loaded.

import type {FieldInfo} from '../protocol/fields';
import type {Manifest, Spread} from '../protocol/manifest';

/** It has one component. */
export interface DerivedField {
  /** The worker's number for it. */
  id: number;
  info: FieldInfo;
  /** The names of the fields that it is made of. That of a series means the shown instant. */
  inputs: string[];
  /** By level the known error, as that of a field; null: it is not known. */
  errors: (Spread | null)[];
}

export interface DerivedFields {
  fields: DerivedField[];
  /** Sentences about definitions that are wrong. */
  errors: string[];
}

/** As a display has them. */
export interface ShownDerived {
  /** Its number among all fields is `first` and more. */
  first: number;
  /** `inputs` are numbers of fields; none: it is not wanted. */
  fields: {id: number; info: FieldInfo; inputs: number[]}[];
}

/** Something that may have derived fields: a display. */
export interface MayDerive {
  derived?: ShownDerived | undefined;
}

/** Null if the field is the manifest's. */
export function derivedIn(
  {derived}: MayDerive,
  field: number,
): ShownDerived['fields'][number] | null {
  return derived?.fields[field - derived.first] ?? null;
}

/** The manifest's fields that a field needs. */
export const inputsIn = (display: MayDerive, field: number): readonly number[] =>
  derivedIn(display, field)?.inputs ?? [field];

export const infoIn = (display: MayDerive, {fields}: Manifest, field: number): FieldInfo =>
  derivedIn(display, field)?.info ?? fields[field]!;

/** The mesh without a warp, as it is now: gradients are taken there. */
export interface RestMesh {
  points: Int32Array;
  tetrahedra: Uint32Array;
  /** The lattice's, of every axis, in the mesh's unit. */
  step: number;
}

/**
 * A field's integers, and how far they are decoded: equal states of an info have equal integers.
 * Null while there are none.
 */
export type ValuesOf = (
  field: number,
) => {info: FieldInfo; values: Int32Array; state: string} | null;
