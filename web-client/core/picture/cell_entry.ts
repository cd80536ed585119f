// Where lines of sight enter the cells: through faces that belong to one cell only, or at the eye,
// if a cell contains it.

import type {Vector} from '../protocol/geometry';
import {isHole} from './section';

type Corners = [Vector, Vector, Vector, Vector];

/**
 * Eight numbers a face: its three corners (anticlockwise seen from outside, lowest number first),
 * the cell's fourth corner, the cell's tag (VolumeCells), and three zeros.
 */
export function entryFaces(
  vertices: Float32Array,
  cells: Uint32Array,
  neighbours: Int32Array,
  tags: Uint32Array,
): Uint32Array {
  const found: number[] = [];
  for (let face = 0; face < neighbours.length; ++face) {
    const cell = face >> 2;
    if (neighbours[face]! >= 0 || isHole(cells, cell)) continue;
    const inner = cells[face]!;
    const [a, b, c] = cells
      .subarray(4 * cell, 4 * cell + 4)
      .filter((id) => id !== inner)
      .sort() as unknown as [number, number, number];
    const outward = orientation([inner, a, b, c].map((id) => place(vertices, id)) as Corners) > 0;
    found.push(a, outward ? b : c, outward ? c : b, inner, tags[cell]!, 0, 0, 0);
  }
  return Uint32Array.from(found);
}

/** The cell that contains `point` (lattice coordinates); -1 if none does. */
export function cellAround(vertices: Float32Array, cells: Uint32Array, point: Vector): number {
  for (let cell = 0; 4 * cell < cells.length; ++cell) {
    if (isHole(cells, cell) || isOutsideBox(vertices, cells, cell, point)) continue;
    const corners = [...cells.subarray(4 * cell, 4 * cell + 4)].map((id) =>
      place(vertices, id),
    ) as Corners;
    const whole = orientation(corners);
    if (
      [0, 1, 2, 3].every(
        (i) =>
          orientation(corners.map((corner, k) => (k === i ? point : corner)) as Corners) * whole >=
          0,
      )
    )
      return cell;
  }
  return -1;
}

function place(vertices: Float32Array, id: number): Vector {
  return [vertices[4 * id]!, vertices[4 * id + 1]!, vertices[4 * id + 2]!];
}

/** Nothing is allocated here: most cells end at this test. */
function isOutsideBox(
  vertices: Float32Array,
  cells: Uint32Array,
  cell: number,
  point: Vector,
): boolean {
  for (let axis = 0; axis < 3; ++axis) {
    let below = 0;
    let above = 0;
    for (let i = 4 * cell; i < 4 * cell + 4; ++i) {
      const x = vertices[4 * cells[i]! + axis]!;
      if (x < point[axis]!) ++below;
      if (x > point[axis]!) ++above;
    }
    if (below === 4 || above === 4) return true;
  }
  return false;
}

/**
 * Six times the volume. It is positive if b, c, d go round anticlockwise seen from the far side of
 * a.
 */
function orientation([a, b, c, d]: Corners): number {
  const bx = b[0] - a[0],
    by = b[1] - a[1],
    bz = b[2] - a[2];
  const cx = c[0] - a[0],
    cy = c[1] - a[1],
    cz = c[2] - a[2];
  const dx = d[0] - a[0],
    dy = d[1] - a[1],
    dz = d[2] - a[2];
  return bx * (cy * dz - cz * dy) + by * (cz * dx - cx * dz) + bz * (cx * dy - cy * dx);
}
