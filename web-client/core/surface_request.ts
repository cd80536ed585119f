// What the isosurfaces on the screen add to a view request: a log of regions refines them where
// they are now, as coarse as they may be.

import type {Display} from './display';
import {scalarRange} from './field_scale';
import {fieldKeys, type FieldInfo} from './manifest';
import {surfaceBoxesOf} from './surface_boxes';
import type {Isovalue, ViewRequest} from './view_request';

/** A view of the protocol has no more (proto/PROTOCOL.md, "View"). */
const kMaxIsovalues = 8;

export type SurfaceRequest = Required<Pick<ViewRequest, 'surfaceBoxes' | 'isovalue'>>;

export const kNoSurfaceRequest: SurfaceRequest = {surfaceBoxes: null, isovalue: null};

/** `positions`: corners of the isosurfaces that `display` asks for. `size`: of the lattice. */
export function surfaceRequest(
  positions: Float32Array,
  {isosurfaces}: Display,
  fields: readonly FieldInfo[],
  size: number,
): SurfaceRequest {
  return {
    surfaceBoxes: surfaceBoxesOf(positions, size),
    isovalue: isosurfaces && isovalueOf(isosurfaces, fields),
  };
}

/** What of the view request is that. */
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

/** As a server is told; null: it would not understand. */
function isovalueOf(
  {scalar: {field, component}, values}: NonNullable<Display['isosurfaces']>,
  fields: readonly FieldInfo[],
): Isovalue | null {
  const info = fields[field];
  if (!info || info.association === 'cell' || values.length > kMaxIsovalues) return null;
  const [low, high] = scalarRange(info, component);
  return {
    field: fieldKeys(fields)[field]!,
    ...(component >= 0 && {component}),
    values: values.map((share) => low + share * (high - low)),
  };
}
