import {expect, test} from 'vitest';
import {backToFront, neighboursOf} from '../core/cell_order';
import type {Vector} from '../core/cell_ray';
import type {Cells} from '../core/section';
import {extinctionOf, kOpacityPath, kTransferSteps, transferTables} from '../core/transfer';
import {cubes} from './cubes';

const cells: Cells = cubes(4, 1000);
const count = cells.tetrahedra.length / 4;

/** Where the line from `eye` along `direction` enters cell `cell`, or null. */
function entry(cell: number, eye: Vector, direction: Vector): number | null {
  const corner = (i: number): Vector => [0, 1, 2].map((axis) => cells.points[3 * cells.tetrahedra[4 * cell + i]! + axis]!) as Vector;
  const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const cross = (a: Vector, b: Vector): Vector => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  let from = 0;
  let to = Infinity;
  for (let i = 0; i < 4; ++i) {
    const [a, b, c] = [1, 2, 3].map((k) => corner((i + k) % 4)) as [Vector, Vector, Vector];
    let normal = cross(minus(b, a), minus(c, a));
    if (dot(normal, minus(corner(i), a)) > 0) normal = normal.map((x) => -x) as Vector;
    const height = dot(normal, minus(a, eye)), speed = dot(normal, direction);
    if (speed > 0) to = Math.min(to, height / speed);
    else if (speed < 0) from = Math.max(from, height / speed);
    else if (height < 0) return null;
  }
  return to > from + 1e-9 ? from : null;
}

test('everyLineOfSightMeetsItsCellsInTheirOrder', () => {
  const neighbours = neighboursOf(cells);
  for (const eye of [[9000, 7000, 5000], [-3000, 50, 20], [370, 410, 40000], [2100, 1700, 1900]] as Vector[]) {
    const order = backToFront(cells, neighbours, eye);
    expect(new Set(order).size).toBe(count);
    for (let ray = 0; ray < 40; ++ray) {
      const target: Vector = [0.1 + (ray % 5) * 0.83, 0.13 + (ray % 7) * 0.54, 0.17 + (ray % 11) * 0.33].map((x) => x * cells.points[cells.points.length - 1]! / 4) as Vector;
      const direction = target.map((x, axis) => x - eye[axis]!) as Vector;
      const entries = [...order].map((cell) => entry(cell, eye, direction)).filter((at) => at !== null);
      expect(entries.length).toBeGreaterThan(0);
      expect(entries).toEqual([...entries].sort((a, b) => b - a));
    }
  }
});

test('aNeighbourSharesThreeCornersAndHolesAreNobodys', () => {
  const some: Cells = {points: cells.points, tetrahedra: cells.tetrahedra.slice(), kept: new Uint8Array(count).fill(1)};
  some.tetrahedra.fill(0, 0, 4);
  some.kept![1] = 0;
  const neighbours = neighboursOf(some);
  expect([...neighbours.subarray(0, 8)]).toEqual(Array(8).fill(-1));
  expect([...neighbours].some((cell) => cell === 0 || cell === 1)).toBe(false);
  for (let face = 0; face < neighbours.length; ++face) {
    const other = neighbours[face]!;
    if (other < 0) continue;
    const mine = some.tetrahedra.subarray(face & ~3, (face & ~3) + 4).filter((_, i) => i !== (face & 3));
    const its = [...some.tetrahedra.subarray(4 * other, 4 * other + 4)];
    expect([...mine].every((vertex) => its.includes(vertex))).toBe(true);
    expect([...neighbours.subarray(4 * other, 4 * other + 4)]).toContain(face >> 2);
  }
  expect(backToFront(some, neighbours, [1e6, 0, 0])).toHaveLength(count - 2);
});

test('theTablesHoldExtinctionAndItsIntegral', () => {
  const {density, integral} = transferTables([0, 0.5], 'grey', false);
  const last = extinctionOf(0.5);
  expect(1 - Math.exp(-last * kOpacityPath)).toBeCloseTo(0.5);
  expect(density[4 * kTransferSteps + 3]).toBeCloseTo(last, 4);
  expect(integral[4 * kTransferSteps + 3]).toBeCloseTo(last / 2, 4);
});
