import {expect, test} from 'vitest';
import {neighboursOf} from '../core/picture/neighbours';
import {cubes} from './cubes';

test('aNeighbourSharesThreeCornersAndHolesAreNobodys', () => {
  const {tetrahedra} = cubes(4, 1000);
  tetrahedra.fill(0, 0, 4);
  const neighbours = neighboursOf(tetrahedra);
  expect([...neighbours.subarray(0, 4)]).toEqual(Array(4).fill(-1));
  expect(neighbours).not.toContain(0);
  let outside = 0;
  for (let face = 0; face < neighbours.length; ++face) {
    const other = neighbours[face]!;
    if (other < 0) ++outside;
    if (other < 0) continue;
    const mine = tetrahedra.subarray(face & ~3, (face & ~3) + 4).filter((_, i) => i !== (face & 3));
    const its = [...tetrahedra.subarray(4 * other, 4 * other + 4)];
    expect([...mine].every((vertex) => its.includes(vertex))).toBe(true);
    expect([...neighbours.subarray(4 * other, 4 * other + 4)]).toContain(face >> 2);
  }
  // Two triangles for each square of the six sides, minus the hole's one, plus the hole's four
  // faces and those of its three neighbours.
  expect(outside).toBe(6 * 4 * 4 * 2 - 1 + 4 + 3);
});
