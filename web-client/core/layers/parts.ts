// Parts: the cells of each value of a label. Some are hidden, seen through, or have a colour of
// their own. Its attributes are read by parts_text.ts, and its cells are found by part_cells.ts.
// Both are loaded on use.

import type {Display, MeshArrays} from '../picture/display';
import type {PartsRequest} from '../picture/parts_request';
import type {CellPaint} from '../picture/section';
import type {Layer, LayerWork} from './layer';

export const parts = {
  name: 'parts',
  more: [{name: 'hidden-parts'}, {name: 'part-opacity'}, {name: 'part-colors'}],
  requestOf: (display: Display) => display.parts ?? null,
} as const satisfies Layer;

/** It is loaded with the first request. */
export const partCells: {
  hiding?: (mesh: MeshArrays, request: PartsRequest) => ((kept: Uint8Array) => void) | null;
  /** Null: all cells are drawn alike. */
  paint?: (mesh: MeshArrays, request: PartsRequest) => CellPaint | null;
} = {};

export const partsWork = {
  layer: parts,

  hiding: (mesh: MeshArrays, display: Display) =>
    (display.parts && partCells.hiding?.(mesh, display.parts)) ?? null,
} satisfies LayerWork;
