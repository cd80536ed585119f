// The principal values and directions of a symmetric tensor, by Jacobi's rotations.

import type {Vector} from '../protocol/geometry';

/** After so many rounds of three rotations nothing is left beside the diagonal. */
const kRounds = 8;

export interface PrincipalAxis {
  value: number;
  /** It has the length 1. */
  direction: Vector;
}

/** `tensor`: xx, yy, zz, xy, yz, xz, as VTK has them. The axes are perpendicular to each other. */
export function principalAxes(tensor: ArrayLike<number>): PrincipalAxis[] {
  const [xx, yy, zz, xy, yz, xz] = Array.from<number>(tensor);
  const m = [
    [xx!, xy!, xz!],
    [xy!, yy!, yz!],
    [xz!, yz!, zz!],
  ];
  const axes = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  for (let round = 0; round < kRounds; ++round)
    for (const [p, q] of [
      [0, 1],
      [0, 2],
      [1, 2],
    ] as const)
      rotate(m, axes, p, q);
  return [0, 1, 2].map((i) => ({
    value: m[i]![i]!,
    direction: axes.map((row) => row[i]!) as Vector,
  }));
}

/** Makes the entry at p, q zero. */
function rotate(m: number[][], axes: number[][], p: number, q: number): void {
  const beside = m[p]![q]!;
  if (beside === 0) return;
  const theta = (m[q]![q]! - m[p]![p]!) / (2 * beside);
  const t = (theta < 0 ? -1 : 1) / (Math.abs(theta) + Math.hypot(theta, 1));
  const c = 1 / Math.hypot(t, 1);
  const s = t * c;
  for (const row of m) turn(row, p, q, [c, s]);
  const [a, b] = [m[p]!, m[q]!];
  for (let k = 0; k < 3; ++k) [a[k], b[k]] = [c * a[k]! - s * b[k]!, s * a[k]! + c * b[k]!];
  for (const row of axes) turn(row, p, q, [c, s]);
}

function turn(row: number[], p: number, q: number, [c, s]: readonly [number, number]): void {
  [row[p], row[q]] = [c * row[p]! - s * row[q]!, s * row[p]! + c * row[q]!];
}
