// The codec's mesh in the form that display.ts needs.

import type {Assembler} from '../decode/assembler';
import type {MeshArrays} from './display';
import {FieldScale} from './field_scale';

/** Views into the codec's memory, valid until the next step; null while there is no mesh. */
export function meshArrays({codec, manifest}: Assembler): MeshArrays | null {
  if (!manifest || codec.chunksApplied === 0) return null;
  return {
    points: codec.points(),
    tetrahedra: codec.tetrahedra(),
    boundary: codec.boundary(),
    scale: ({field, component}) => {
      const info = manifest.fields[field];
      const values = info && codec.field(field, info.components);
      return info && values ? new FieldScale(values, info, component) : null;
    },
  };
}
