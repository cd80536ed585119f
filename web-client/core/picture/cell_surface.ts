// The surface of a set of cells: every face that belongs to only one of them, seen from outside,
// with its cell.

import type {FieldScale} from './field_scale';
import type {Cells} from './section';
import {soupOf, type CreasesOf, type TriangleSoup} from './triangle_soup';

/** Corners of the face opposite to corner i. */
const kFaces = [
  [1, 2, 3],
  [0, 3, 2],
  [0, 1, 3],
  [0, 2, 1],
] as const;
const kEmpty = -1;

/**
 * Each face is 4 * cell + the opposite corner. `boundary` is the whole mesh's, 3 vertices a
 * triangle; it only saves work.
 */
export function surfaceFaces(cells: Cells, boundary: Uint32Array): Uint32Array {
  const near = verticesNearASide(cells, boundary);
  const candidates = candidateFaces(cells, near);
  // Open addressing, at most half full. A face that comes a second time lies between two cells and
  // cancels the first one.
  const mask = 2 ** Math.ceil(Math.log2(2 * candidates.length + 2)) - 1;
  const slots = new Int32Array(mask + 1).fill(kEmpty);
  const inner = new Uint8Array(candidates.length);
  const kinds = cells.paint?.kindOf;
  const kindOf = (i: number): number => kinds?.(candidates[i]! >> 2) ?? 0;
  const corners = new Uint32Array(3 * candidates.length);
  for (let i = 0; i < candidates.length; ++i) {
    const [a, b, c] = sortedCorners(cells.tetrahedra, candidates[i]!);
    corners.set([a, b, c], 3 * i);
    let slot = (Math.imul(a, 73856093) ^ Math.imul(b, 19349663) ^ Math.imul(c, 83492791)) & mask;
    for (; ; slot = (slot + 1) & mask) {
      const other = slots[slot]!;
      if (other === kEmpty) {
        slots[slot] = i;
        break;
      }
      if (corners[3 * other] !== a || corners[3 * other + 1] !== b || corners[3 * other + 2] !== c)
        continue;
      const [kind, otherKind] = [kindOf(i), kindOf(other)];
      if (kind <= otherKind) inner[i] = 1;
      if (kind >= otherKind) inner[other] = 1;
      break;
    }
  }
  return candidates.filter((_, i) => inner[i] === 0);
}

/** The faces as a soup. */
export function facesSoup(
  {points, tetrahedra, paint}: Cells,
  faces: Uint32Array,
  scale: FieldScale | null,
  creasesOf: CreasesOf | null = null,
): TriangleSoup {
  const triangles = new Uint32Array(3 * faces.length);
  faces.forEach((face, i) => triangles.set(outwardCorners(points, tetrahedra, face), 3 * i));
  const cellOf = (corner: number): number => faces[Math.trunc(corner / 3)]! >> 2;
  const valueOf =
    scale &&
    ((corner: number): number => scale.at(scale.ofCells ? cellOf(corner) : triangles[corner]!));
  const soup = soupOf(points, triangles, valueOf);
  triangles.forEach((_, corner) => paint?.write(soup, corner, cellOf(corner)));
  return creasesOf ? {...soup, creases: creasesOf(points, triangles)} : soup;
}

/**
 * Only faces between these vertices can be on the surface: vertices of the mesh's boundary, of
 * cells that are not kept, and between kinds.
 */
function verticesNearASide(
  {points, tetrahedra, kept, paint}: Cells,
  boundary: Uint32Array,
): Uint8Array {
  const near = new Uint8Array(points.length / 3);
  for (const vertex of boundary) near[vertex] = 1;
  if (kept)
    for (let at = 0; at < tetrahedra.length; ++at)
      if (kept[at >> 2] === 0) near[tetrahedra[at]!] = 1;
  const kindOf = paint?.kindOf;
  if (!kindOf) return near;
  const first = new Int32Array(near.length).fill(kEmpty);
  for (let at = 0; at < tetrahedra.length; ++at) {
    const kind = kindOf(at >> 2);
    const vertex = tetrahedra[at]!;
    if (first[vertex] === kEmpty) first[vertex] = kind;
    else if (first[vertex] !== kind) near[vertex] = 1;
  }
  return near;
}

function candidateFaces({tetrahedra, kept}: Cells, near: Uint8Array): Uint32Array {
  const faces: number[] = [];
  for (let cell = 0, at = 0; at < tetrahedra.length; ++cell, at += 4) {
    if (kept?.[cell] === 0) continue;
    const n0 = near[tetrahedra[at]!]!,
      n1 = near[tetrahedra[at + 1]!]!,
      n2 = near[tetrahedra[at + 2]!]!,
      n3 = near[tetrahedra[at + 3]!]!;
    if (n1 & n2 & n3) faces.push(at);
    if (n0 & n2 & n3) faces.push(at + 1);
    if (n0 & n1 & n3) faces.push(at + 2);
    if (n0 & n1 & n2) faces.push(at + 3);
  }
  return Uint32Array.from(faces);
}

function sortedCorners(tetrahedra: Uint32Array, face: number): [number, number, number] {
  const at = face & ~3;
  const [i, j, k] = kFaces[face & 3]!;
  let a = tetrahedra[at + i]!,
    b = tetrahedra[at + j]!,
    c = tetrahedra[at + k]!;
  if (a > b) [a, b] = [b, a];
  if (b > c) [b, c] = [c, b];
  if (a > b) [a, b] = [b, a];
  return [a, b, c];
}

function outwardCorners(
  points: Int32Array,
  tetrahedra: Uint32Array,
  face: number,
): [number, number, number] {
  const at = face & ~3;
  const [i, j, k] = kFaces[face & 3]!;
  const a = tetrahedra[at + i]!,
    b = tetrahedra[at + j]!,
    c = tetrahedra[at + k]!,
    inside = tetrahedra[face]!;
  const difference = (p: number, axis: number): number =>
    points[3 * p + axis]! - points[3 * a + axis]!;
  const [ux, uy, uz] = [difference(b, 0), difference(b, 1), difference(b, 2)];
  const [vx, vy, vz] = [difference(c, 0), difference(c, 1), difference(c, 2)];
  const side =
    (uy * vz - uz * vy) * difference(inside, 0) +
    (uz * vx - ux * vz) * difference(inside, 1) +
    (ux * vy - uy * vx) * difference(inside, 2);
  return side <= 0 ? [a, b, c] : [a, c, b];
}
