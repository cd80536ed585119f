// The threshold hides cells whose values lie outside of a range.

import {keepWithin} from '../picture/cell_choice';
import type {Display, MeshArrays} from '../picture/display';
import {fieldLayer} from './field_layer';
import type {FieldValues} from './field_values';
import type {FieldLayer, LayerWork} from './layer';

export const threshold = {
  ...fieldLayer('threshold', {pointsOnly: false, count: 2}),
  name: 'threshold',

  put(display: Display, request: FieldValues | null): void {
    const [low, high] = request?.values ?? [];
    display.threshold = request && {scalar: request.scalar, low: low!, high: high!};
  },
  requestOf: ({threshold: request}: Display) => request,
} as const satisfies FieldLayer;

export const thresholdWork = {
  layer: threshold,

  hiding(mesh: MeshArrays, {threshold: request}: Display): ((kept: Uint8Array) => void) | null {
    const scale = request && mesh.scale(request.scalar);
    return scale
      ? (kept) => keepWithin(kept, mesh.tetrahedra, scale, request.low, request.high)
      : null;
  },
} satisfies LayerWork;
