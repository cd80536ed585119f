// The part of a view request that comes from isosurfaces. A log of regions refines them where they
// are now, however coarse they are.

import {surfaceBoxesOf} from '../protocol/surface_boxes';
import type {Isovalue, ViewRequest} from '../protocol/view_request';

export type SurfaceRequest = Required<Pick<ViewRequest, 'surfaceBoxes' | 'isovalue'>>;

export const kNoSurfaceRequest: SurfaceRequest = {surfaceBoxes: null, isovalue: null};

/** `positions` holds the corners of triangles that show the isovalue. `size` is the lattice's. */
export function surfaceRequest(
  positions: Float32Array,
  isovalue: Isovalue | null,
  size: number,
): SurfaceRequest {
  return {surfaceBoxes: surfaceBoxesOf(positions, size), isovalue};
}

/** That part of a view request. */
export function surfaceRequestOf({
  surfaceBoxes = null,
  isovalue = null,
}: ViewRequest): SurfaceRequest {
  return {surfaceBoxes, isovalue};
}

export function asksForTheSame(a: SurfaceRequest, b: SurfaceRequest): boolean {
  return (
    String(a.surfaceBoxes) === String(b.surfaceBoxes) &&
    JSON.stringify(a.isovalue) === JSON.stringify(b.isovalue)
  );
}
