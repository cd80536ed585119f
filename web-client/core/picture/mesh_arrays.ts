// The codec's mesh in the form that display.ts needs.

import type {Assembler} from '../decode/assembler';
import type {Manifest} from '../protocol/manifest';
import {derivation} from './derivation';
import {derivedIn, type MayDerive, type RestMesh, type ValuesOf} from './derived_field';
import type {MeshArrays} from './display';
import {FieldScale} from './field_scale';
import {LabelScale} from './labels';
import {warpedPoints, type Warp} from './warp';

/** The last moved vertices of a mesh, and what they were made of. */
interface Moved {
  manifest: Manifest;
  key: string;
  points: Int32Array;
}

const kept = new WeakMap<Assembler, Moved>();

/**
 * Views into the codec's memory, valid until the next step; null while there is no mesh. `warp`
 * moves the vertices. They rest while its field has no values. Derived fields are those of the
 * display.
 */
export function meshArrays(
  assembler: Assembler,
  display: {warp?: Warp | null} & MayDerive = {},
): MeshArrays | null {
  const {codec, manifest} = assembler;
  if (!manifest || codec.chunksApplied === 0) return null;
  const {warp} = display;
  const valuesOf: ValuesOf = (field) => {
    const info = manifest.fields[field];
    const values = info && codec.field(field, info.components);
    const state = [codec.chunksApplied, codec.fieldChunksApplied(field)].join();
    return values ? {info, values, state} : null;
  };
  const restMesh = (): RestMesh => ({
    points: codec.points(),
    tetrahedra: codec.tetrahedra(),
    step: manifest.lattice.step,
  });
  return {
    points: (warp && movedPoints(assembler, manifest, warp)) ?? codec.points(),
    tetrahedra: codec.tetrahedra(),
    boundary: codec.boundary(),
    scale: ({field, component}, labelColors) => {
      const derived = derivedIn(display, field);
      if (derived) return derivation.scale?.(derived, valuesOf, restMesh()) ?? null;
      const its = valuesOf(field);
      if (!its) return null;
      const {info, values} = its;
      return labelColors ? new LabelScale(values, info) : new FieldScale(values, info, component);
    },
  };
}

/** Pictures and questions about them share the result. Null: there are no vectors. */
function movedPoints(
  assembler: Assembler,
  manifest: Manifest,
  {field, scale}: Warp,
): Int32Array | null {
  const {codec} = assembler;
  const info = manifest.fields[field];
  const values = info?.components === 3 && info.association === 'point' && codec.field(field, 3);
  if (!values || scale === 0) return null;
  const state = [codec.chunksApplied, codec.fieldChunksApplied(field), codec.vertexCount];
  const key = [field, scale, ...state].join();
  const last = kept.get(assembler);
  if (last?.key === key && last.manifest === manifest) return last.points;
  const mesh = {points: codec.points(), tetrahedra: codec.tetrahedra()};
  const points = warpedPoints(mesh, values, info, scale / manifest.lattice.step);
  kept.set(assembler, {manifest, key, points});
  return points;
}
