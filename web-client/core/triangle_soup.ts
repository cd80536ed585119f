// What the renderer draws: triangles without shared corners, so that a shader can tell a corner's number from the vertex's and
// draw edges of even width.

import type {FieldScale} from './field_scale';

export interface TriangleSoup {
  /** 9 lattice coordinates a triangle */
  positions: Float32Array;
  /** 3 field values a triangle, in [0, 1] over the field's range; empty when there is no field */
  values: Float32Array;
  /** Triangles from this one on are halves of quads: the side opposite to their first corner is no edge of the mesh. */
  firstHalf: number;
}

/** The boundary as a soup. `points`: 3 a vertex, `triangles`: 3 a triangle. */
export function boundarySoup(points: Int32Array, triangles: Uint32Array, scale: FieldScale | null): TriangleSoup {
  const positions = new Float32Array(3 * triangles.length);
  const values = new Float32Array(scale ? triangles.length : 0);
  for (let corner = 0; corner < triangles.length; ++corner) {
    const vertex = triangles[corner]!;
    positions[3 * corner] = points[3 * vertex]!;
    positions[3 * corner + 1] = points[3 * vertex + 1]!;
    positions[3 * corner + 2] = points[3 * vertex + 2]!;
    if (scale) values[corner] = scale.at(vertex);
  }
  return {positions, values, firstHalf: triangles.length / 3};
}

/** Smallest and largest lattice coordinates: [x0, y0, z0, x1, y1, z1]. REQUIRES: at least one triangle. */
export function soupBounds(soup: TriangleSoup): number[] {
  const bounds = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
  for (let i = 0; i < soup.positions.length; ++i) {
    const axis = i % 3;
    const value = soup.positions[i]!;
    if (value < bounds[axis]!) bounds[axis] = value;
    if (value > bounds[axis + 3]!) bounds[axis + 3] = value;
  }
  return bounds;
}
