// The lines of a display, from the codec's mesh as it is now.

import type {Assembler} from '../decode/assembler';
import {colorScale, cuttingPlanes, type Display, type MeshArrays} from '../picture/display';
import type {lateMaking} from '../picture/late_making';
import type {LineSoup} from '../picture/streamlines';
import type {Vector} from '../protocol/geometry';
import type {Manifest} from '../protocol/manifest';
import {Arrows} from './arrows';
import {remembered} from './neighbour_memory';
import {Streamlines} from './streamlines';
import type {Vectors} from './vector_walk';

type Across = (cell: number, corner: number) => number;

/** By the mesh's log what walks have found in it. */
const memories = new WeakMap<
  Assembler,
  {chunks: number; manifest: Manifest | null; across: Across}
>();

/** Null while the vectors have no values. */
export const lines: typeof lateMaking.lines = (assembler, mesh, display) =>
  linesIn(assembler, mesh, display)?.all(display.streamlines!.seeds) ?? null;

/** As `lines`. */
export const arrows: typeof lateMaking.arrows = (assembler, mesh, display) => {
  const request = display.arrows;
  const vectors = request ? vectorsIn(assembler, request.field, [3, 6]) : null;
  if (!vectors) return null;
  const {body, mode, planes} = display;
  const {bits, step} = assembler.manifest!.lattice;
  return new Arrows(
    {...mesh, step, across: acrossIn(assembler), longest: 2 ** bits},
    vectors,
    request!,
  ).all(
    {
      hasSurface: body && mode !== 'slice',
      cutting: cuttingPlanes(display),
      cuts: mode === 'cells' ? [] : planes,
    },
    colorScale(mesh, display),
  );
};

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
  const vectors = request ? vectorsIn(assembler, request.field) : null;
  if (!vectors) return null;
  const {points, tetrahedra, boundary} = mesh;
  const {step} = assembler.manifest!.lattice;
  // instants that have come; there are more with each picture
  const instants = (request!.instants ?? []).flatMap(({field, time}) => {
    const its = vectorsIn(assembler, field);
    return its ? [{...its, time}] : [];
  });
  const begin = request!.instants?.find(({field}) => field === request!.field)?.time;
  const changes = begin !== undefined && instants.length > 1 ? {instants, begin} : null;
  if (request!.instants && !changes) return null;
  return new Streamlines(
    {points, tetrahedra, boundary, step, across: acrossIn(assembler)},
    vectors,
    request!.limits,
    colorScale(mesh, display),
    changes,
  );
}

function vectorsIn(
  {codec, manifest}: Assembler,
  field: number,
  components: readonly number[] = [3],
): Vectors | null {
  const info = manifest?.fields[field];
  const values = info && codec.isWhole ? codec.field(field, info.components) : null;
  if (!values || !components.includes(info!.components) || info!.association !== 'point')
    return null;
  return {values, info: info!};
}

function acrossIn(assembler: Assembler): Across {
  const {codec, manifest} = assembler;
  const chunks = codec.chunksApplied;
  const known = memories.get(assembler);
  if (known?.chunks === chunks && known.manifest === manifest) return known.across;
  const across = remembered(codec.tetrahedronCount, (cell, corner) => codec.across(cell, corner));
  memories.set(assembler, {chunks, manifest, across});
  return across;
}
