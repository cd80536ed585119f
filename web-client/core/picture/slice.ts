// Sections of the mesh by planes and isovalues.

import type {Plane} from '../protocol/geometry';
import type {FieldScale} from './field_scale';
import {section, type Cells} from './section';
import type {TriangleSoup} from './triangle_soup';

/** The cross-section by a plane, coloured by `scale`. */
export function slice(cells: Cells, scale: FieldScale | null, plane: Plane): TriangleSoup {
  return section(cells, planeDistances(cells.points, plane), scale);
}

/**
 * The surface where the point field `levels` equals `value` (in [0, 1], as it gives values),
 * coloured by `scale`. REQUIRES: `levels` is a field of points.
 */
export function isosurface(
  cells: Cells,
  levels: FieldScale,
  value: number,
  scale: FieldScale | null,
): TriangleSoup {
  const distances = new Float64Array(cells.points.length / 3);
  for (let v = 0; v < distances.length; ++v) distances[v] = levels.at(v) - value;
  return section(cells, distances, scale);
}

/** Each vertex's height above the plane, times the normal's length. */
export function planeDistances(points: Int32Array, plane: Plane): Float64Array {
  const [nx, ny, nz] = plane.normal;
  const distances = new Float64Array(points.length / 3);
  for (let v = 0, i = 0; v < distances.length; ++v, i += 3) {
    distances[v] = nx * points[i]! + ny * points[i + 1]! + nz * points[i + 2]! - plane.offset;
  }
  return distances;
}
