// The lines of a display, from the codec's mesh as it is now.

import type {Assembler} from '../decode/assembler';
import {colorScale, type Display, type MeshArrays} from '../picture/display';
import type {LineSoup} from '../picture/streamlines';
import type {Vector} from '../protocol/geometry';
import {remembered} from './neighbour_memory';
import {Streamlines} from './streamlines';

type Across = (cell: number, corner: number) => number;

/** By the mesh's log what walks have found in it. */
const memories = new WeakMap<Assembler, {chunks: number; across: Across}>();

/** Null while the vectors have no values. */
export function make(assembler: Assembler, mesh: MeshArrays, display: Display): LineSoup | null {
  return linesIn(assembler, mesh, display)?.all(display.streamlines!.seeds) ?? null;
}

/** The line through a place of a cell. Null: there is none. */
export function makeAt(
  assembler: Assembler,
  mesh: MeshArrays,
  display: Display,
  {cell, place}: {cell: number; place: Vector},
): LineSoup | null {
  return linesIn(assembler, mesh, display)?.at(cell, place) ?? null;
}

function linesIn(assembler: Assembler, mesh: MeshArrays, display: Display): Streamlines | null {
  const request = display.streamlines;
  const {codec, manifest} = assembler;
  const info = request && manifest?.fields[request.field];
  const values = info && codec.isWhole ? codec.field(request.field, info.components) : null;
  if (!values || info!.components !== 3 || info!.association !== 'point') return null;
  const {points, tetrahedra, boundary} = mesh;
  const {step} = manifest!.lattice;
  return new Streamlines(
    {points, tetrahedra, boundary, step, across: acrossIn(assembler)},
    {values, info: info!},
    request!.limits,
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
