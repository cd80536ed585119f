// Cells from back to front, for blending them over one another: P. L. Williams, "Visibility-ordering meshed polyhedra", ACM TOG 11 (1992). Of two cells
// that share a face the one on the eye's far side comes first; where no face tells, the farther middle does (his heuristic for meshes with holes).

import type {Vector} from './cell_ray';
import type {Cells} from './section';

const kNone = -1;
/** Depths are sorted by so many classes. */
const kDepthClasses = 1 << 16;

/** Neighbours across the faces opposite to the four corners, 4 a cell; -1: none. Cells that are not kept, and holes, have none and are none's. */
export function neighboursOf({tetrahedra, kept}: Cells): Int32Array {
  const neighbours = new Int32Array(tetrahedra.length).fill(kNone);
  // Open addressing, at most half full; a slot holds 4 * cell + corner of a face whose other side has not come yet.
  const mask = 2 ** Math.ceil(Math.log2(4 * tetrahedra.length + 2)) - 1;
  const slots = new Int32Array(mask + 1).fill(kNone);
  for (let cell = 0; 4 * cell < tetrahedra.length; ++cell) {
    if (!isDrawn(tetrahedra, kept, cell)) continue;
    for (let corner = 0; corner < 4; ++corner) {
      const face = 4 * cell + corner;
      let slot = hashOf(tetrahedra, face) & mask;
      for (; slots[slot] !== kNone; slot = (slot + 1) & mask) {
        const other = slots[slot]!;
        if (neighbours[other] !== kNone || !sameFace(tetrahedra, face, other)) continue;
        neighbours[face] = other >> 2;
        neighbours[other] = cell;
        break;
      }
      if (neighbours[face] === kNone) slots[slot] = face;
    }
  }
  return neighbours;
}

function isDrawn(tetrahedra: Uint32Array, kept: Uint8Array | null | undefined, cell: number): boolean {
  return (!kept || kept[cell] === 1) && tetrahedra[4 * cell] !== tetrahedra[4 * cell + 1];
}

/** The same for the three corners in any order. */
function hashOf(tetrahedra: Uint32Array, face: number): number {
  const at = face & ~3, corner = face & 3;
  let sum = 0;
  let mix = 0;
  for (let i = 0; i < 4; ++i) {
    if (i === corner) continue;
    const vertex = tetrahedra[at + i]!;
    sum = (sum + vertex) | 0;
    mix ^= Math.imul(vertex, 0x9e3779b1);
  }
  mix = Math.imul(mix ^ (mix >>> 15), 0x85ebca6b) + sum;
  return mix ^ (mix >>> 13);
}

function sameFace(tetrahedra: Uint32Array, a: number, b: number): boolean {
  const atA = a & ~3, atB = b & ~3;
  for (let i = 0; i < 4; ++i) {
    if (i === (a & 3)) continue;
    const vertex = tetrahedra[atA + i];
    let found = false;
    for (let k = 0; k < 4; ++k) found ||= k !== (b & 3) && tetrahedra[atB + k] === vertex;
    if (!found) return false;
  }
  return true;
}

/** The drawn cells, farthest first as seen from `eye` (lattice coordinates). REQUIRES: `neighbours` of the same cells. */
export function backToFront(cells: Cells, neighbours: Int32Array, eye: Vector): Uint32Array {
  const {tetrahedra, kept} = cells;
  const starts = byDepth(cells, eye);
  const order = new Uint32Array(starts.length);
  const seen = new Uint8Array(tetrahedra.length / 4);
  const stack = new Uint32Array(starts.length + 1);
  const nextFace = new Uint8Array(tetrahedra.length / 4);
  const behind = facesInFront(cells, eye);
  let count = 0;
  for (const start of starts) {
    if (seen[start]) continue;
    let top = 0;
    stack[0] = start;
    seen[start] = 1;
    while (top >= 0) {
      const cell = stack[top]!;
      const corner = nextFace[cell]!++;
      if (corner === 4) {
        order[count++] = cell;
        --top;
        continue;
      }
      const neighbour = neighbours[4 * cell + corner]!;
      if (neighbour === kNone || seen[neighbour] || behind[cell]! & (1 << corner) || !isDrawn(tetrahedra, kept, neighbour)) continue;
      seen[neighbour] = 1;
      stack[++top] = neighbour;
    }
  }
  return order.subarray(0, count);
}

/** Bit i of a cell: the eye lies beyond the face opposite to corner i, so the neighbour there is nearer. */
function facesInFront({points, tetrahedra}: Cells, [ex, ey, ez]: Vector): Uint8Array {
  const bits = new Uint8Array(tetrahedra.length / 4);
  for (let cell = 0, at = 0; at < tetrahedra.length; ++cell, at += 4) {
    const a = 3 * tetrahedra[at]!, b = 3 * tetrahedra[at + 1]!, c = 3 * tetrahedra[at + 2]!, d = 3 * tetrahedra[at + 3]!;
    const x = points[a]!, y = points[a + 1]!, z = points[a + 2]!;
    const bx = points[b]! - x, by = points[b + 1]! - y, bz = points[b + 2]! - z;
    const cx = points[c]! - x, cy = points[c + 1]! - y, cz = points[c + 2]! - z;
    const dx = points[d]! - x, dy = points[d + 1]! - y, dz = points[d + 2]! - z;
    const px = ex - x, py = ey - y, pz = ez - z;
    // The eye's barycentric coordinates times the cell's volume, by Cramer's rule.
    const volume = bx * (cy * dz - cz * dy) + by * (cz * dx - cx * dz) + bz * (cx * dy - cy * dx);
    const atB = px * (cy * dz - cz * dy) + py * (cz * dx - cx * dz) + pz * (cx * dy - cy * dx);
    const atC = bx * (py * dz - pz * dy) + by * (pz * dx - px * dz) + bz * (px * dy - py * dx);
    const atD = bx * (cy * pz - cz * py) + by * (cz * px - cx * pz) + bz * (cx * py - cy * px);
    const sign = volume < 0 ? -1 : 1;
    bits[cell] = (sign * (volume - atB - atC - atD) < 0 ? 1 : 0) | (sign * atB < 0 ? 2 : 0) | (sign * atC < 0 ? 4 : 0) | (sign * atD < 0 ? 8 : 0);
  }
  return bits;
}

/** The drawn cells by the distance of their middles, farthest first, in classes. */
function byDepth({points, tetrahedra, kept}: Cells, [ex, ey, ez]: Vector): Uint32Array {
  const cells = tetrahedra.length / 4;
  const depths = new Float64Array(cells);
  let least = Infinity;
  let most = -Infinity;
  let drawn = 0;
  for (let cell = 0; cell < cells; ++cell) {
    if (!isDrawn(tetrahedra, kept, cell)) continue;
    ++drawn;
    let x = -4 * ex, y = -4 * ey, z = -4 * ez;
    for (let i = 4 * cell; i < 4 * cell + 4; ++i) {
      const at = 3 * tetrahedra[i]!;
      x += points[at]!;
      y += points[at + 1]!;
      z += points[at + 2]!;
    }
    const depth = Math.sqrt(x * x + y * y + z * z);
    depths[cell] = depth;
    if (depth < least) least = depth;
    if (depth > most) most = depth;
  }
  const scale = most > least ? (kDepthClasses - 1) / (most - least) : 0;
  const starts = new Uint32Array(kDepthClasses + 1);
  const classOf = (cell: number): number => Math.floor((most - depths[cell]!) * scale);
  for (let cell = 0; cell < cells; ++cell) if (isDrawn(tetrahedra, kept, cell)) ++starts[classOf(cell) + 1]!;
  for (let k = 0; k < kDepthClasses; ++k) starts[k + 1]! += starts[k]!;
  const sorted = new Uint32Array(drawn);
  for (let cell = 0; cell < cells; ++cell) if (isDrawn(tetrahedra, kept, cell)) sorted[starts[classOf(cell)]!++] = cell;
  return sorted;
}
