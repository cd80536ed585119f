// Isosurfaces: where a field of points has one of some values.

import type {Stretch} from '../picture/cell_ray';
import {along, valueAt, type Ray} from '../picture/cell_value';
import {colorScale, type Display, type MeshArrays} from '../picture/display';
import {isosurface} from '../picture/slice';
import {joinSoups, type TriangleSoup} from '../picture/triangle_soup';
import {fieldLayer} from './field_layer';
import type {FieldValues} from './field_values';
import type {FieldLayer, LayerWork} from './layer';

export const isosurfaces = {
  ...fieldLayer('iso', {pointsOnly: true}),
  name: 'iso',
  // The polygons are sections of cells, not the mesh. Their edges would hide the shape.
  draw: {edges: false, member: 'isosurface'},

  put(display: Display, request: FieldValues | null): void {
    display.isosurfaces = request;
  },
  requestOf: ({isosurfaces: request}: Display) => request,
} as const satisfies FieldLayer;

export const isosurfacesWork = {
  layer: isosurfaces,

  make(mesh: MeshArrays, display: Display, kept: Uint8Array | null): TriangleSoup | null {
    const levels = display.isosurfaces && mesh.scale(display.isosurfaces.scalar);
    if (!levels || levels.ofCells) return null;
    const scale = colorScale(mesh, display);
    const cells = {...mesh, kept, paint: null};
    return joinSoups(
      display.isosurfaces!.values.map((value) => isosurface(cells, levels, value, scale)),
    );
  },

  seenFrom(mesh: MeshArrays, {isosurfaces: request}: Display, ray: Ray, seen: Stretch): number {
    const levels = request && mesh.scale(request.scalar);
    if (!levels || levels.ofCells) return Infinity;
    const first = valueAt(mesh, levels, seen.cell, along(ray, seen.from));
    const last = valueAt(mesh, levels, seen.cell, along(ray, seen.to));
    let t = Infinity;
    for (const value of request.values) {
      const share = (value - first) / (last - first);
      if (share >= 0 && share <= 1) t = Math.min(t, seen.from + share * (seen.to - seen.from));
    }
    return t;
  },
} satisfies LayerWork;
