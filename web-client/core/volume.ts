// The cells themselves for a renderer that looks through them, and their order from back to front for any eye.

import type {Vector} from './cell_ray';
import {backToFront, neighboursOf} from './cell_order';
import type {MeshNow} from './display';
import type {FieldScale} from './field_scale';
import type {Cells} from './section';

export interface VolumeCells {
  /** Counts meshes and fields: an order belongs to the cells of its version. */
  version: number;
  /** 4 a vertex: place on the lattice and value in [0, 1]; values of a field of cells stand in `cellValues` instead. */
  vertices: Float32Array;
  /** 4 vertices a cell */
  cells: Uint32Array;
  cellValues: Float32Array | null;
}

export interface CellOrder {
  version: number;
  /** Farthest first. */
  order: Uint32Array;
}

const kNoCells: Cells = {points: new Int32Array(0), tetrahedra: new Uint32Array(0)};

/** Copies of the mesh as it was, because the codec's memory moves on. */
export class Volume {
  private version = 0;
  private cells: Cells = kNoCells;
  private neighbours: Int32Array = new Int32Array(0);

  /** Takes over the mesh and gives the renderer its own copy. Cells with a corner whose value is missing are left out. */
  take(mesh: MeshNow, scale: FieldScale, kept: Uint8Array | null): VolumeCells {
    const tetrahedra = mesh.tetrahedra.slice();
    const vertices = new Float32Array((4 * mesh.points.length) / 3);
    for (let v = 0; 4 * v < vertices.length; ++v) {
      for (let axis = 0; axis < 3; ++axis) vertices[4 * v + axis] = mesh.points[3 * v + axis]!;
      if (!scale.ofCells) vertices[4 * v + 3] = scale.at(v);
    }
    const cellValues = scale.ofCells ? Float32Array.from({length: tetrahedra.length / 4}, (_, cell) => scale.at(cell)) : null;
    this.cells = {points: mesh.points.slice(), tetrahedra, kept: withValues(tetrahedra, vertices, cellValues, kept)};
    this.neighbours = neighboursOf(this.cells);
    return {version: ++this.version, vertices, cells: tetrahedra.slice(), cellValues};
  }

  forget(): void {
    this.cells = kNoCells;
    this.neighbours = new Int32Array(0);
  }

  order(eye: Vector): CellOrder { return {version: this.version, order: backToFront(this.cells, this.neighbours, eye).slice()}; }
}

function withValues(tetrahedra: Uint32Array, vertices: Float32Array, cellValues: Float32Array | null, kept: Uint8Array | null): Uint8Array | null {
  let some: Uint8Array | null = kept;
  for (let cell = 0; 4 * cell < tetrahedra.length; ++cell) {
    let value = cellValues ? cellValues[cell]! : 0;
    if (!cellValues) for (let i = 4 * cell; i < 4 * cell + 4; ++i) value += vertices[4 * tetrahedra[i]! + 3]!;
    if (!Number.isNaN(value)) continue;
    some ??= new Uint8Array(tetrahedra.length / 4).fill(1);
    some[cell] = 0;
  }
  return some;
}
