// The section of the mesh where a function that is linear in each cell is zero: a plane's cut or an
// isosurface. Each crossed cell gives one triangle or quad. Its sides are the cell's own,
// interpolated along the cell's edges.

import type {FieldScale} from './field_scale';
import type {TriangleSoup} from './triangle_soup';

/**
 * Views of the mesh: 3 lattice coordinates a vertex, 4 vertices a tetrahedron. Only cells whose
 * `kept` is 1 count; without `kept` all do.
 */
export interface Cells {
  points: Int32Array;
  tetrahedra: Uint32Array;
  kept?: Uint8Array | null;
  /** Null or absent: all are drawn alike. */
  paint?: CellPaint | null;
}

/** A slot in the codec's arrays whose cell has not arrived yet. */
export function isHole(tetrahedra: Uint32Array, cell: number): boolean {
  return tetrahedra[4 * cell] === tetrahedra[4 * cell + 1];
}

/** How cells are drawn. */
export interface CellPaint {
  /** From 0 to 65535; null: all are alike. Between two kinds the side of the higher is drawn. */
  kindOf: ((cell: number) => number) | null;
  /** Gives a corner of the soup the paint of a cell. */
  write(soup: TriangleSoup, corner: number, cell: number): void;
}

/** For each pattern of corners above zero: the corner alone, then the other three. */
const kTriangleOf: Record<number, number[]> = {
  0b0001: [0, 1, 2, 3],
  0b1110: [0, 1, 2, 3],
  0b0010: [1, 0, 2, 3],
  0b1101: [1, 0, 2, 3],
  0b0100: [2, 0, 1, 3],
  0b1011: [2, 0, 1, 3],
  0b1000: [3, 0, 1, 2],
  0b0111: [3, 0, 1, 2],
};
/**
 * For each pattern of two corners above zero: the pairs a b | c d. The quad goes round by the edges
 * (a c), (a d), (b d), (b c).
 */
const kQuadOf: Record<number, number[]> = {
  0b0011: [0, 1, 2, 3],
  0b1100: [0, 1, 2, 3],
  0b0101: [0, 2, 1, 3],
  0b1010: [0, 2, 1, 3],
  0b1001: [0, 3, 1, 2],
  0b0110: [0, 3, 1, 2],
};

/**
 * `distances` is the function, one number a vertex. A corner at zero counts as above, so that no
 * section is lost or doubled. A cell with a NaN corner has none.
 */
export function section(
  cells: Cells,
  distances: Float64Array,
  scale: FieldScale | null,
): TriangleSoup {
  const {tetrahedra} = cells;
  const {crossed, triangles, quads} = crossedCells(cells, distances);
  const corners = 3 * (triangles + 2 * quads);
  const soup: TriangleSoup = {
    positions: new Float32Array(3 * corners),
    values: new Float32Array(scale ? corners : 0),
    firstHalf: triangles,
  };
  const cut = new CutWriter(cells, distances, scale, soup);
  let triangle = 0;
  let half = triangles;
  for (const cell of crossed) {
    const above = pattern(tetrahedra, distances, 4 * cell);
    const three = kTriangleOf[above];
    cut.cell = cell;
    if (three) {
      const alone = tetrahedra[4 * cell + three[0]!]!;
      for (let i = 0; i < 3; ++i)
        cut.write(3 * triangle + i, alone, tetrahedra[4 * cell + three[i + 1]!]!);
      ++triangle;
      continue;
    }
    const four = kQuadOf[above]!;
    const a = tetrahedra[4 * cell + four[0]!]!,
      b = tetrahedra[4 * cell + four[1]!]!;
    const c = tetrahedra[4 * cell + four[2]!]!,
      d = tetrahedra[4 * cell + four[3]!]!;
    // The quad p0..p3 becomes (p1, p2, p0) and (p3, p0, p2): the diagonal p0 p2 lies opposite to
    // the first corner of both.
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

function pattern(tetrahedra: Uint32Array, distances: Float64Array, at: number): number {
  return (
    (distances[tetrahedra[at]!]! >= 0 ? 1 : 0) |
    (distances[tetrahedra[at + 1]!]! >= 0 ? 2 : 0) |
    (distances[tetrahedra[at + 2]!]! >= 0 ? 4 : 0) |
    (distances[tetrahedra[at + 3]!]! >= 0 ? 8 : 0)
  );
}

function crossedCells(
  {tetrahedra, kept}: Cells,
  distances: Float64Array,
): {crossed: number[]; triangles: number; quads: number} {
  const crossed: number[] = [];
  let triangles = 0;
  let quads = 0;
  for (let cell = 0, at = 0; at < tetrahedra.length; ++cell, at += 4) {
    if (kept?.[cell] === 0) continue;
    const above = pattern(tetrahedra, distances, at);
    if (above === 0 || above === 15) continue;
    let sum = 0;
    for (let i = 0; i < 4; ++i) sum += distances[tetrahedra[at + i]!]!;
    if (Number.isNaN(sum)) continue;
    const corners = (above & 1) + ((above >> 1) & 1) + ((above >> 2) & 1) + (above >> 3);
    if (corners === 2) ++quads;
    else ++triangles;
    crossed.push(cell);
  }
  return {crossed, triangles, quads};
}

class CutWriter {
  cell = 0;

  constructor(
    private readonly cells: Cells,
    private readonly distances: Float64Array,
    private readonly scale: FieldScale | null,
    private readonly soup: TriangleSoup,
  ) {}

  /**
   * Writes the point where the edge (p, q) is zero. The lower id comes first, so that neighbours
   * write the same floats.
   */
  write(corner: number, p: number, q: number): void {
    if (p > q) [p, q] = [q, p];
    const {points, paint} = this.cells;
    paint?.write(this.soup, corner, this.cell);
    const t = this.distances[p]! / (this.distances[p]! - this.distances[q]!);
    for (let axis = 0; axis < 3; ++axis) {
      const from = points[3 * p + axis]!;
      this.soup.positions[3 * corner + axis] = from + t * (points[3 * q + axis]! - from);
    }
    if (!this.scale) return;
    if (this.scale.ofCells) {
      this.soup.values[corner] = this.scale.at(this.cell);
      return;
    }
    const from = this.scale.at(p);
    this.soup.values[corner] = from + t * (this.scale.at(q) - from);
  }
}
