// The cross-section of a tetrahedral mesh by a plane: one triangle or quad for every cell that the plane cuts, with the field
// interpolated along the cell's edges, so that the sides drawn are the cells' own.

import type {FieldScale} from './field_scale';
import type {TriangleSoup} from './triangle_soup';

/** The points with normal . p = offset, in lattice coordinates; what lies above (normal . p > offset) is cut away. */
export interface Plane {
  normal: [number, number, number];
  offset: number;
}

/** The tetrahedra's corners [alone, the other three] and [pair, other pair] for each pattern of corners above the plane. */
const kTriangleOf: Record<number, number[]> = {
  0b0001: [0, 1, 2, 3], 0b1110: [0, 1, 2, 3], 0b0010: [1, 0, 2, 3], 0b1101: [1, 0, 2, 3],
  0b0100: [2, 0, 1, 3], 0b1011: [2, 0, 1, 3], 0b1000: [3, 0, 1, 2], 0b0111: [3, 0, 1, 2],
};
/** Quad corners in a round: edges (a c), (a d), (b d), (b c) of the pairs a b | c d. */
const kQuadOf: Record<number, number[]> = {
  0b0011: [0, 1, 2, 3], 0b1100: [0, 1, 2, 3], 0b0101: [0, 2, 1, 3], 0b1010: [0, 2, 1, 3], 0b1001: [0, 3, 1, 2], 0b0110: [0, 3, 1, 2],
};

/** `points`: 3 a vertex, `tetrahedra`: 4 a cell. A corner on the plane counts as above it, so no cell's cut is lost or doubled. */
export function slice(points: Int32Array, tetrahedra: Uint32Array, scale: FieldScale | null, plane: Plane): TriangleSoup {
  const distances = vertexDistances(points, plane);
  const {triangles, quads} = countCuts(tetrahedra, distances);
  const soup: TriangleSoup = {
    positions: new Float32Array(9 * (triangles + 2 * quads)),
    values: new Float32Array(scale ? 3 * (triangles + 2 * quads) : 0),
    firstHalf: triangles,
  };
  const cut = new CutWriter(points, distances, scale, soup);
  let triangle = 0;
  let half = triangles;
  for (let cell = 0; cell < tetrahedra.length; cell += 4) {
    const above = pattern(tetrahedra, distances, cell);
    if (above === 0 || above === 15) continue;
    const three = kTriangleOf[above];
    if (three) {
      const alone = tetrahedra[cell + three[0]!]!;
      for (let i = 0; i < 3; ++i) cut.write(3 * triangle + i, alone, tetrahedra[cell + three[i + 1]!]!);
      ++triangle;
      continue;
    }
    const four = kQuadOf[above]!;
    const [a, b, c, d] = four.map((corner) => tetrahedra[cell + corner]!) as [number, number, number, number];
    // The quad p0..p3 as (p1, p2, p0) and (p3, p0, p2): the diagonal p0 p2 lies opposite to the first corner of both.
    cut.write(3 * half, a, d);
    cut.write(3 * half + 1, b, d);
    cut.write(3 * half + 2, a, c);
    cut.write(3 * half + 3, b, c);
    cut.write(3 * half + 4, a, c);
    cut.write(3 * half + 5, b, d);
    half += 2;
  }
  return soup;
}

function vertexDistances(points: Int32Array, plane: Plane): Float64Array {
  const [nx, ny, nz] = plane.normal;
  const distances = new Float64Array(points.length / 3);
  for (let v = 0, i = 0; v < distances.length; ++v, i += 3) {
    distances[v] = nx * points[i]! + ny * points[i + 1]! + nz * points[i + 2]! - plane.offset;
  }
  return distances;
}

function pattern(tetrahedra: Uint32Array, distances: Float64Array, cell: number): number {
  return (distances[tetrahedra[cell]!]! >= 0 ? 1 : 0) | (distances[tetrahedra[cell + 1]!]! >= 0 ? 2 : 0) |
         (distances[tetrahedra[cell + 2]!]! >= 0 ? 4 : 0) | (distances[tetrahedra[cell + 3]!]! >= 0 ? 8 : 0);
}

function countCuts(tetrahedra: Uint32Array, distances: Float64Array): {triangles: number; quads: number} {
  let triangles = 0;
  let quads = 0;
  for (let cell = 0; cell < tetrahedra.length; cell += 4) {
    const above = pattern(tetrahedra, distances, cell);
    if (above === 0 || above === 15) continue;
    const corners = (above & 1) + ((above >> 1) & 1) + ((above >> 2) & 1) + (above >> 3);
    if (corners === 2) ++quads;
    else ++triangles;
  }
  return {triangles, quads};
}

class CutWriter {
  constructor(
    private readonly points: Int32Array, private readonly distances: Float64Array, private readonly scale: FieldScale | null,
    private readonly soup: TriangleSoup) {}

  /** Writes the point where edge (p, q) meets the plane. The lower id goes first, so that neighbours write the same floats. */
  write(corner: number, p: number, q: number): void {
    if (p > q) [p, q] = [q, p];
    const t = this.distances[p]! / (this.distances[p]! - this.distances[q]!);
    for (let axis = 0; axis < 3; ++axis) {
      const from = this.points[3 * p + axis]!;
      this.soup.positions[3 * corner + axis] = from + t * (this.points[3 * q + axis]! - from);
    }
    if (!this.scale) return;
    const from = this.scale.at(p);
    this.soup.values[corner] = from + t * (this.scale.at(q) - from);
  }
}
