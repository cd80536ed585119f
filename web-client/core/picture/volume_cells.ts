// Makes the cells for a renderer that looks through them.

import {entryFaces} from './cell_entry';
import type {MeshArrays} from './display';
import type {FieldScale} from './field_scale';
import {neighboursOf} from './neighbours';
import {isHole} from './section';
import {kHiddenCell, type VolumeCells} from './volume';

/**
 * Copies the mesh, because the codec's memory moves. Cells are hidden if they are not `kept` (null
 * keeps all) or a corner's value is missing.
 */
export function volumeCells(
  mesh: MeshArrays,
  scale: FieldScale,
  kept: Uint8Array | null,
): VolumeCells {
  const cells = sortedCells(mesh.tetrahedra);
  const vertices = new Float32Array((4 * mesh.points.length) / 3);
  for (let v = 0; 4 * v < vertices.length; ++v) {
    for (let axis = 0; axis < 3; ++axis) vertices[4 * v + axis] = mesh.points[3 * v + axis]!;
    if (!scale.ofCells) vertices[4 * v + 3] = scale.at(v);
  }
  const cellValues = scale.ofCells
    ? Float32Array.from({length: cells.length / 4}, (_, cell) => scale.at(cell))
    : null;
  const isHidden = (cell: number): boolean => {
    let value = cellValues ? cellValues[cell]! : 0;
    if (!cellValues)
      for (let i = 4 * cell; i < 4 * cell + 4; ++i) value += vertices[4 * cells[i]! + 3]!;
    return kept?.[cell] === 0 || Number.isNaN(value);
  };
  const tags = new Uint32Array(cells.length / 4);
  for (let cell = 0; cell < tags.length; ++cell)
    tags[cell] = 1 + cell + (isHidden(cell) ? kHiddenCell : 0);
  const neighbours = neighboursOf(cells);
  return {
    vertices,
    cells,
    tags,
    links: linksOf(cells, neighbours, tags),
    entries: entryFaces(vertices, cells, neighbours, tags),
    cellValues,
  };
}

function sortedCells(tetrahedra: Uint32Array): Uint32Array {
  const cells = tetrahedra.slice();
  for (let at = 0; at < cells.length; at += 4) {
    if (isHole(cells, at >> 2)) continue;
    for (let i = at + 1; i < at + 4; ++i) {
      const id = cells[i]!;
      let to = i;
      for (; to > at && cells[to - 1]! > id; --to) cells[to] = cells[to - 1]!;
      cells[to] = id;
    }
  }
  return cells;
}

function linksOf(cells: Uint32Array, neighbours: Int32Array, tags: Uint32Array): Uint32Array {
  const links = new Uint32Array(2 * neighbours.length);
  for (let face = 0; face < neighbours.length; ++face) {
    const other = neighbours[face]!;
    if (other < 0) continue;
    let back = 4 * other;
    while (neighbours[back] !== face >> 2) ++back;
    links[2 * face] = tags[other]!;
    links[2 * face + 1] = cells[back]!;
  }
  return links;
}
