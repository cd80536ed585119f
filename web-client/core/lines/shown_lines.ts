// The lines of a display, from the codec's mesh as it is now.

import type {Assembler} from '../decode/assembler';
import {colorScale, type Display, type MeshArrays} from '../picture/display';
import type {LineSoup} from '../picture/streamlines';
import {remembered} from './neighbour_memory';
import {streamlinesOf} from './streamlines';

type Across = (cell: number, corner: number) => number;

/** By the mesh's log what walks have found in it. */
const memories = new WeakMap<Assembler, {chunks: number; across: Across}>();

/** Null while the vectors have no values. */
export function make(assembler: Assembler, mesh: MeshArrays, display: Display): LineSoup | null {
  const request = display.streamlines;
  const {codec, manifest} = assembler;
  const info = request && manifest?.fields[request.field];
  const values = info && codec.isWhole ? codec.field(request.field, info.components) : null;
  if (!values || info!.components !== 3 || info!.association !== 'point') return null;
  const {points, tetrahedra, boundary} = mesh;
  const {step} = manifest!.lattice;
  const across = acrossIn(assembler);
  return streamlinesOf(
    {points, tetrahedra, boundary, step, across},
    {values, info: info!},
    request!,
    colorScale(mesh, display),
  );
}

function acrossIn(assembler: Assembler): Across {
  const {codec} = assembler;
  const known = memories.get(assembler);
  if (known?.chunks === codec.chunksApplied) return known.across;
  const across = remembered(codec.tetrahedronCount, (cell, corner) => codec.across(cell, corner));
  memories.set(assembler, {chunks: codec.chunksApplied, across});
  return across;
}
