// The display that the page wants, and how it is made from the mesh: plain data in, triangles out.

import type {ArrowsRequest} from './arrows';
import type {PartsRequest} from './parts_request';
import type {Plane} from '../protocol/geometry';
import {facesSoup, surfaceFaces} from './cell_surface';
import type {MayDerive} from './derived_field';
import type {FieldScale, Scalar} from './field_scale';
import type {CellPaint, Cells} from './section';
import {slice} from './slice';
import {boundarySoup, type CreasesOf, type TriangleSoup} from './triangle_soup';
import type {StreamlinesRequest} from './streamlines';
import type {Warp} from './warp';

/**
 * cut: the part above a plane is removed, and flat caps close the hole. cells: whole cells stay or
 * go. slice: only the cuts are shown, each whole.
 */
export type ClipMode = 'cut' | 'cells' | 'slice';
export const kClipModes: readonly ClipMode[] = ['cut', 'cells', 'slice'];
export const kMaxPlanes = 3;

export interface Display extends MayDerive {
  color: Scalar | null;
  /** The values are those of LabelScale: `color` is a label in the map `labels`. */
  labelColors?: boolean;
  /** False: only cuts and isosurfaces are drawn. */
  body: boolean;
  mode: ClipMode;
  /** The parts above any of them are cut away. */
  planes: Plane[];
  /** The values are in [0, 1] over the point field's scalarRange. */
  isosurfaces: {scalar: Scalar; values: number[]} | null;
  /** Hides cells outside [low, high]. Both are in [0, 1] over the scalarRange. */
  threshold: {scalar: Scalar; low: number; high: number} | null;
  /** Moves the vertices. Everything else is made of the moved mesh; null: it is at rest. */
  warp: Warp | null;
  /** Draws the creases of the mesh at rest as lines while a warp moves it. */
  restEdges: boolean;
  /** Shows the cells themselves, translucent, coloured by `color`. */
  volume: boolean;
  /** The vector field whose flux is asked for, so that it is fetched; by default the colour. */
  flux?: Scalar | null;
  /** Fields that may be shown soon: they are fetched and decoded behind all else. */
  ahead?: number[];
  parts?: PartsRequest | null;
  streamlines?: StreamlinesRequest | null;
  arrows?: ArrowsRequest | null;
  /** Layers without a member of their own, by name; the values are in [0, 1], too. */
  layers?: Record<string, {scalar: Scalar; values: number[]}>;
}

export const kPlainDisplay: Display = {
  color: null,
  body: true,
  mode: 'cut',
  planes: [],
  isosurfaces: null,
  threshold: null,
  warp: null,
  restEdges: false,
  volume: false,
};

/** The mesh as it is now. `scale` is null while a field has no values. */
export interface MeshArrays {
  points: Int32Array;
  tetrahedra: Uint32Array;
  boundary: Uint32Array;
  /** As Cells.paint. */
  paint?: CellPaint | null;
  scale(scalar: Scalar, labelColors?: boolean): FieldScale | null;
}

/** The values that colour; null while there are none. */
export function colorScale(
  mesh: Pick<MeshArrays, 'scale'>,
  {color, labelColors}: Display,
): FieldScale | null {
  return color && mesh.scale(color, labelColors);
}

/**
 * The planes that the renderer must cut by. The `cells` mode has cut already, and slices cut
 * nothing.
 */
export function cuttingPlanes(display: Display): Plane[] {
  return display.mode === 'cut' ? display.planes : [];
}

export function surfaceOf(
  mesh: MeshArrays,
  display: Display,
  kept: Uint8Array | null,
  creasesOf: CreasesOf | null = null,
): TriangleSoup {
  const scale = colorScale(mesh, display);
  const {points, boundary} = mesh;
  const cells: Cells = {...mesh, kept};
  if (kept || mesh.paint || scale?.ofCells)
    return facesSoup(cells, surfaceFaces(cells, boundary), scale, creasesOf);
  const soup = boundarySoup(points, boundary, scale);
  return creasesOf ? {...soup, creases: creasesOf(points, boundary)} : soup;
}

/**
 * One soup a plane. The renderer hides the parts of each that lie above the other cutting planes.
 */
export function cutsOf(
  mesh: MeshArrays,
  display: Display,
  kept: Uint8Array | null,
): TriangleSoup[] {
  const scale = colorScale(mesh, display);
  const planes = display.mode === 'cells' ? [] : display.planes;
  return planes.map((plane) => slice({...mesh, kept}, scale, plane));
}
