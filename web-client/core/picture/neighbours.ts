// Finds each cell's neighbours: a line of sight passes from one to the next.

import {isHole} from './section';

const kNone = -1;

/**
 * Four neighbours a cell, across the faces opposite to its corners; -1 if there is none. Holes have
 * no neighbours and are nobody's.
 */
export function neighboursOf(tetrahedra: Uint32Array): Int32Array {
  const neighbours = new Int32Array(tetrahedra.length).fill(kNone);
  // Open addressing, at most half full. A slot holds 4 * cell + corner of a face whose other side
  // has not come yet.
  const mask = 2 ** Math.ceil(Math.log2(4 * tetrahedra.length + 2)) - 1;
  const slots = new Int32Array(mask + 1).fill(kNone);
  for (let face = 0; face < tetrahedra.length; ++face) {
    if (isHole(tetrahedra, face >> 2)) continue;
    let slot = hashOf(tetrahedra, face) & mask;
    for (; slots[slot] !== kNone; slot = (slot + 1) & mask) {
      const other = slots[slot]!;
      if (neighbours[other] !== kNone || !sameFace(tetrahedra, face, other)) continue;
      neighbours[face] = other >> 2;
      neighbours[other] = face >> 2;
      break;
    }
    if (neighbours[face] === kNone) slots[slot] = face;
  }
  return neighbours;
}

/** Does not depend on the order of the three corners. */
function hashOf(tetrahedra: Uint32Array, face: number): number {
  const at = face & ~3,
    corner = face & 3;
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
  const atA = a & ~3,
    atB = b & ~3;
  for (let i = 0; i < 4; ++i) {
    if (i === (a & 3)) continue;
    const vertex = tetrahedra[atA + i];
    let found = false;
    for (let k = 0; k < 4; ++k) found ||= k !== (b & 3) && tetrahedra[atB + k] === vertex;
    if (!found) return false;
  }
  return true;
}
