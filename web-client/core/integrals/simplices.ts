// Tetrahedra and triangles below planes, and what they add to integrals of a function that is
// linear in each of them. All formulas are exact.

import type {Plane, Vector} from '../protocol/geometry';

/** A place, and the value there; NaN if it is missing. */
export type Corner = [x: number, y: number, z: number, value: number];

const heightOf = ({normal: [a, b, c], offset}: Plane, [x, y, z]: Corner): number =>
  a * x + b * y + c * z - offset;

/** The corner where an edge meets a plane, by the heights of its ends. */
function between(p: Corner, q: Corner, atP: number, atQ: number): Corner {
  const t = atP / (atP - atQ);
  return p.map((from, i) => from + t * (q[i]! - from)) as Corner;
}

/** Triangles that cover the part of a triangle below all planes. They are seen from its side. */
export function trianglesBelow(triangle: Corner[], planes: readonly Plane[]): Corner[][] {
  let polygon = triangle;
  for (const plane of planes) {
    const heights = polygon.map((corner) => heightOf(plane, corner));
    if (heights.every((its) => its <= 0)) continue;
    polygon = polygon.flatMap((corner, i) => {
      const next = (i + 1) % polygon.length;
      const [here, there] = [heights[i]!, heights[next]!];
      const isCrossed = here < 0 !== there < 0 && here !== 0 && there !== 0;
      return [
        ...(here <= 0 ? [corner] : []),
        ...(isCrossed ? [between(corner, polygon[next]!, here, there)] : []),
      ];
    });
  }
  return polygon.slice(2).map((last, i) => [polygon[0]!, polygon[i + 1]!, last]);
}

/** Tetrahedra that fill the part of a tetrahedron below all planes. */
export function tetrahedraBelow(tetrahedron: Corner[], planes: readonly Plane[]): Corner[][] {
  return planes.reduce(
    (parts, plane) => parts.flatMap((part) => partsBelow(part, plane)),
    [tetrahedron],
  );
}

function partsBelow(corners: Corner[], plane: Plane): Corner[][] {
  const heights = corners.map((corner) => heightOf(plane, corner));
  if (heights.every((its) => its <= 0)) return [corners];
  const below = [0, 1, 2, 3].filter((i) => heights[i]! <= 0);
  const above = [0, 1, 2, 3].filter((i) => heights[i]! > 0);
  const cut = (p: number, q: number): Corner =>
    between(corners[p]!, corners[q]!, heights[p]!, heights[q]!);
  const its = below.map((i) => corners[i]!);
  const [first, second] = below as [number, number];
  switch (below.length) {
    case 0:
      return [];
    case 1:
      return [[its[0]!, ...above.map((i) => cut(first, i))]];
    case 2:
      return prism(
        [its[0]!, ...above.map((i) => cut(first, i))],
        [its[1]!, ...above.map((i) => cut(second, i))],
      );
    default:
      return prism(
        its,
        below.map((i) => cut(i, above[0]!)),
      );
  }
}

/** `p` and `q` are its triangles; their corners follow each other alike. */
const prism = (p: Corner[], q: Corner[]): Corner[][] =>
  [
    [p[0], p[1], p[2], q[0]],
    [p[1], p[2], q[0], q[1]],
    [p[2], q[0], q[1], q[2]],
  ] as Corner[][];

/** Half the cross product of two sides: as long as the area, towards whom the triangle is seen. */
export function areaVector([a, b, c]: readonly Corner[]): Vector {
  const [ux, uy, uz] = [b![0] - a![0], b![1] - a![1], b![2] - a![2]];
  const [vx, vy, vz] = [c![0] - a![0], c![1] - a![1], c![2] - a![2]];
  return [(uy * vz - uz * vy) / 2, (uz * vx - ux * vz) / 2, (ux * vy - uy * vx) / 2];
}

export function volumeOf([a, b, c, d]: readonly Corner[]): number {
  const [x, y, z] = areaVector([a!, b!, c!]);
  return Math.abs(x * (d![0] - a![0]) + y * (d![1] - a![1]) + z * (d![2] - a![2])) / 3;
}

export interface Extreme {
  value: number;
  /** On the lattice. */
  place: Vector;
}

export interface Moments {
  /** The whole volume or area, and the part of it that has values. */
  size: number;
  valued: number;
  /** Those of the values; NaN without any. */
  mean: number;
  deviation: number;
  least: Extreme | null;
  largest: Extreme | null;
}

/** Adds up tetrahedra, or triangles. */
export class Sum {
  private size = 0;
  private valued = 0;
  /** Integrals of the value and of its square, both from `from`: large values keep their digits. */
  private first = 0;
  private second = 0;
  private from = NaN;
  private least: Extreme | null = null;
  private largest: Extreme | null = null;

  /** `ofCells`: a value is that of a whole simplex, and occurs in its middle. */
  constructor(private readonly ofCells: boolean) {}

  /** `size` is the simplex's volume or area. */
  add(corners: readonly Corner[], size: number): void {
    const {length} = corners;
    this.size += size;
    let sum = 0;
    for (let i = 0; i < length; ++i) sum += corners[i]![3];
    if (Number.isNaN(sum) || !(size > 0)) return;
    if (Number.isNaN(this.from)) this.from = sum / length;
    this.valued += size;
    let [one, two] = [0, 0];
    for (let i = 0; i < length; ++i) {
      const away = corners[i]![3] - this.from;
      one += away;
      two += away * away;
    }
    this.first += (size * one) / length;
    // The integral of the product of two corners' shares is the same for each pair, and for the
    // square of one twice as much.
    this.second += (size * (one * one + two)) / (length * (length + 1));
    for (let i = 0; i < length; ++i) this.mark(corners, i);
  }

  moments(): Moments {
    const {size, valued, least, largest} = this;
    const mean = this.first / valued;
    const deviation = Math.sqrt(Math.max(0, this.second / valued - mean * mean));
    return {size, valued, mean: this.from + mean, deviation, least, largest};
  }

  private mark(corners: readonly Corner[], i: number): void {
    const value = corners[i]![3];
    const isLeast = this.least === null || value < this.least.value;
    const isLargest = this.largest === null || value > this.largest.value;
    if (!isLeast && !isLargest) return;
    const place = this.ofCells
      ? [0, 1, 2].map((axis) => corners.reduce((sum, its) => sum + its[axis]!, 0) / corners.length)
      : corners[i]!.slice(0, 3);
    const extreme = {value, place: place as Vector};
    if (isLeast) this.least = extreme;
    if (isLargest) this.largest = extreme;
  }
}
