// Gradients of fields of points. In a cell a field is linear, so that its gradient is constant
// there. A vertex has the mean of its cells, weighted by their volumes.

import type {RestMesh} from '../picture/derived_field';

/** Numbers a vertex: the gradient along x, y and z, and six times the volume of its cells. */
export const kSlopeWidth = 4;

/**
 * The gradients of fields with a value a vertex, each kSlopeWidth numbers a vertex. Cells with a
 * missing value do not count. Where none is left the gradient is NaN.
 */
export function slopesOf(mesh: RestMesh, fields: readonly Float64Array[]): Float64Array[] {
  const slopes = fields.map((values) => new Float64Array(kSlopeWidth * values.length));
  addCells(mesh, fields, slopes);
  for (const all of slopes) {
    for (let at = 0; at < all.length; at += kSlopeWidth) {
      const weight = all[at + 3]! * mesh.step;
      for (let axis = 0; axis < 3; ++axis) all[at + axis] = all[at + axis]! / weight;
    }
  }
  return slopes;
}

/**
 * Adds gradients times six volumes on the lattice. This product has no division, so that flat
 * cells add little. Holes have no volume. The body is one loop: calls would take twice the time.
 */
function addCells(
  {points, tetrahedra}: RestMesh,
  fields: readonly Float64Array[],
  slopes: readonly Float64Array[],
): void {
  for (let cell = 0; cell < tetrahedra.length; cell += 4) {
    const a = tetrahedra[cell]!;
    const b = tetrahedra[cell + 1]!;
    const c = tetrahedra[cell + 2]!;
    const d = tetrahedra[cell + 3]!;
    if (a === b) continue;
    const [x, y, z] = [points[3 * a]!, points[3 * a + 1]!, points[3 * a + 2]!];
    const [bx, by, bz] = [points[3 * b]! - x, points[3 * b + 1]! - y, points[3 * b + 2]! - z];
    const [cx, cy, cz] = [points[3 * c]! - x, points[3 * c + 1]! - y, points[3 * c + 2]! - z];
    const [dx, dy, dz] = [points[3 * d]! - x, points[3 * d + 1]! - y, points[3 * d + 2]! - z];
    const [px, py, pz] = [cy * dz - cz * dy, cz * dx - cx * dz, cx * dy - cy * dx];
    const [qx, qy, qz] = [dy * bz - dz * by, dz * bx - dx * bz, dx * by - dy * bx];
    const [rx, ry, rz] = [by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx];
    const signed = bx * px + by * py + bz * pz;
    const sign = Math.sign(signed);
    if (sign === 0) continue;
    const weight = sign * signed;
    for (let i = 0; i < fields.length; ++i) {
      const values = fields[i]!;
      const from = values[a]!;
      const u = sign * (values[b]! - from);
      const v = sign * (values[c]! - from);
      const w = sign * (values[d]! - from);
      const gx = u * px + v * qx + w * rx;
      const gy = u * py + v * qy + w * ry;
      const gz = u * pz + v * qz + w * rz;
      if (!Number.isFinite(gx + gy + gz)) continue;
      const all = slopes[i]!;
      for (let corner = cell; corner < cell + 4; ++corner) {
        const at = kSlopeWidth * tetrahedra[corner]!;
        all[at] = all[at]! + gx;
        all[at + 1] = all[at + 1]! + gy;
        all[at + 2] = all[at + 2]! + gz;
        all[at + 3] = all[at + 3]! + weight;
      }
    }
  }
}
