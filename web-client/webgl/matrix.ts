// Vectors, and matrices of 16 numbers, column by column.

import type {Vector} from '../core/protocol/geometry';

export type Matrix = readonly number[];

export const sum = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const scaled = (a: Vector, by: number): Vector => [a[0] * by, a[1] * by, a[2] * by];
export const difference = (a: Vector, b: Vector): Vector => sum(a, scaled(b, -1));
export const lengthOf = (a: Vector): number => Math.hypot(...a);
/** A vector without a length stays. */
export const unit = (a: Vector): Vector => scaled(a, 1 / (lengthOf(a) || 1));

/** Maps by `b`, then by `a`. */
export function product(a: Matrix, b: Matrix): number[] {
  return Array.from({length: 16}, (_, at) => {
    const row = at % 4,
      column = at - row;
    let value = 0;
    for (let k = 0; k < 4; ++k) value += a[4 * k + row]! * b[column + k]!;
    return value;
  });
}

/** By cofactors of pairs of rows. Zeros if there is no inverse. */
export function inverse(m: Matrix): number[] {
  // The determinants of rows i and j in the first two columns, and in the last two.
  const left = (i: number, j: number): number => m[i]! * m[4 + j]! - m[4 + i]! * m[j]!;
  const right = (i: number, j: number): number => m[8 + i]! * m[12 + j]! - m[12 + i]! * m[8 + j]!;
  const [s01, s02, s03] = [left(0, 1), left(0, 2), left(0, 3)];
  const [s12, s13, s23] = [left(1, 2), left(1, 3), left(2, 3)];
  const [c01, c02, c03] = [right(0, 1), right(0, 2), right(0, 3)];
  const [c12, c13, c23] = [right(1, 2), right(1, 3), right(2, 3)];
  const determinant = s01 * c23 - s02 * c13 + s03 * c12 + s12 * c03 - s13 * c02 + s23 * c01;
  if (determinant === 0) return new Array<number>(16).fill(0);
  const at = (row: number, column: number): number => m[4 * column + row]!;
  const inverted = [
    at(1, 1) * c23 - at(2, 1) * c13 + at(3, 1) * c12,
    -at(1, 0) * c23 + at(2, 0) * c13 - at(3, 0) * c12,
    at(1, 3) * s23 - at(2, 3) * s13 + at(3, 3) * s12,
    -at(1, 2) * s23 + at(2, 2) * s13 - at(3, 2) * s12,
    -at(0, 1) * c23 + at(2, 1) * c03 - at(3, 1) * c02,
    at(0, 0) * c23 - at(2, 0) * c03 + at(3, 0) * c02,
    -at(0, 3) * s23 + at(2, 3) * s03 - at(3, 3) * s02,
    at(0, 2) * s23 - at(2, 2) * s03 + at(3, 2) * s02,
    at(0, 1) * c13 - at(1, 1) * c03 + at(3, 1) * c01,
    -at(0, 0) * c13 + at(1, 0) * c03 - at(3, 0) * c01,
    at(0, 3) * s13 - at(1, 3) * s03 + at(3, 3) * s01,
    -at(0, 2) * s13 + at(1, 2) * s03 - at(3, 2) * s01,
    -at(0, 1) * c12 + at(1, 1) * c02 - at(2, 1) * c01,
    at(0, 0) * c12 - at(1, 0) * c02 + at(2, 0) * c01,
    -at(0, 3) * s12 + at(1, 3) * s02 - at(2, 3) * s01,
    at(0, 2) * s12 - at(1, 2) * s02 + at(2, 2) * s01,
  ];
  return inverted.map((value) => value / determinant);
}

/** Divided by its homogeneous coordinate. */
export function transformed(matrix: Matrix, [x, y, z]: Vector): Vector {
  const row = (i: number): number =>
    matrix[i]! * x + matrix[i + 4]! * y + matrix[i + 8]! * z + matrix[i + 12]!;
  const w = row(3);
  return [row(0) / w, row(1) / w, row(2) / w];
}
