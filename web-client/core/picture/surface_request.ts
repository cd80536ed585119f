// The part of a view request that comes from isosurfaces. A log of regions refines them where they
// are now, however coarse they are.

import {fieldKeys, type FieldInfo} from '../protocol/manifest';
import {surfaceBoxesOf} from '../protocol/surface_boxes';
import type {Isovalue, ViewRequest} from '../protocol/view_request';
import type {Display} from './display';
import {scalarRange} from './field_scale';

/** The protocol allows no more (proto/STREAM.md, "View"). */
const kMaxIsovalues = 8;

export type SurfaceRequest = Required<Pick<ViewRequest, 'surfaceBoxes' | 'isovalue'>>;

export const kNoSurfaceRequest: SurfaceRequest = {surfaceBoxes: null, isovalue: null};

/** `positions` holds the corners of the isosurfaces of `display`. `size` is the lattice's. */
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

/** In the server's terms; null if it would not understand. */
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
