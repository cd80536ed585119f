// The renderer draws triangles without shared corners. A shader can tell the corner from the
// vertex's number and draw edges of even width.

import type {FieldScale} from './field_scale';

export interface TriangleSoup {
  /** 9 lattice coordinates a triangle */
  positions: Float32Array;
  /** 3 field values a triangle, in [0, 1] over the field's range; empty when there is no field */
  values: Float32Array;
  /**
   * Triangles from this one on are halves of quads. The side opposite to their first corner is no
   * edge of the mesh.
   */
  firstHalf: number;
  /** False: the sides of its triangles are no edges of cells. */
  edges?: boolean;
  /** paintOf each corner; absent: all are plain. */
  paint?: Uint8Array;
  /** Some of its triangles may be seen through. */
  hasClear?: boolean;
  /** CreasesOf it; absent: it has none. */
  creases?: Uint8Array;
}

/**
 * Finds the sides of a surface's triangles that are drawn as lines. The result has a byte for each
 * corner, the same for all of a triangle. Its bit k is the side opposite to corner k. `points`: 3 a
 * vertex; `triangles`: 3 a triangle, all seen from outside. It is creasesOf of creases.ts, which
 * comes behind the first picture.
 */
export type CreasesOf = (points: Int32Array, triangles: Uint32Array) => Uint8Array;

/** The boundary as a soup. `points`: 3 a vertex, `triangles`: 3 a triangle. */
export function boundarySoup(
  points: Int32Array,
  triangles: Uint32Array,
  scale: FieldScale | null,
): TriangleSoup {
  return soupOf(points, triangles, scale && ((corner) => scale.at(triangles[corner]!)));
}

/** As boundarySoup. `valueOf` is asked for each corner; null: there is no field. */
export function soupOf(
  points: Int32Array,
  triangles: Uint32Array,
  valueOf: ((corner: number) => number) | null,
): TriangleSoup {
  const positions = new Float32Array(3 * triangles.length);
  const values = new Float32Array(valueOf ? triangles.length : 0);
  for (let corner = 0; corner < triangles.length; ++corner) {
    const vertex = triangles[corner]!;
    positions[3 * corner] = points[3 * vertex]!;
    positions[3 * corner + 1] = points[3 * vertex + 1]!;
    positions[3 * corner + 2] = points[3 * vertex + 2]!;
    if (valueOf) values[corner] = valueOf(corner);
  }
  return {positions, values, firstHalf: triangles.length / 3};
}

/** An empty soup, new each time, because soups are transferred. */
export function noSoup(): TriangleSoup {
  return {positions: new Float32Array(0), values: new Float32Array(0), firstHalf: 0};
}

/**
 * The bounds of the triangles' vertices on the lattice: [x0, y0, z0, x1, y1, z1]. REQUIRES: at
 * least one triangle.
 */
export function pointBounds(points: Int32Array, triangles: Uint32Array): number[] {
  const bounds = [0, 1, 2].map((axis) => {
    let low = Infinity,
      high = -Infinity;
    for (let i = 0; i < triangles.length; ++i) {
      const value = points[3 * triangles[i]! + axis]!;
      if (value < low) low = value;
      if (value > high) high = value;
    }
    return [low, high] as const;
  });
  return [...bounds.map(([low]) => low), ...bounds.map(([, high]) => high)];
}

/** Joins soups: whole triangles first, then the halves of quads. */
export function joinSoups(soups: TriangleSoup[]): TriangleSoup {
  const sum = (size: (soup: TriangleSoup) => number): number =>
    soups.reduce((all, soup) => all + size(soup), 0);
  const joined: TriangleSoup = {
    positions: new Float32Array(sum(({positions}) => positions.length)),
    values: new Float32Array(sum(({values}) => values.length)),
    firstHalf: sum(({firstHalf}) => firstHalf),
  };
  let at = 0;
  const append = ({positions, values}: TriangleSoup, from: number, to: number): void => {
    joined.positions.set(positions.subarray(9 * from, 9 * to), 9 * at);
    if (values.length > 0) joined.values.set(values.subarray(3 * from, 3 * to), 3 * at);
    at += to - from;
  };
  for (const soup of soups) append(soup, 0, soup.firstHalf);
  for (const soup of soups) append(soup, soup.firstHalf, soup.positions.length / 9);
  return joined;
}
