// The cells for a renderer that looks through them.

export interface VolumeCells {
  /**
   * 4 numbers a vertex: its place on the lattice, and its value in [0, 1]. Values of a cell field
   * stand in `cellValues` instead.
   */
  vertices: Float32Array;
  /** 4 vertices a cell, in ascending order. */
  cells: Uint32Array;
  /** 1 + the cell; kHiddenCell is added if the cell is invisible. */
  tags: Uint32Array;
  /**
   * 2 numbers for each face, opposite to a cell's four corners: the tag of the cell beyond, and its
   * vertex off the face. 0, 0 means the boundary.
   */
  links: Uint32Array;
  /** The result of entryFaces. */
  entries: Uint32Array;
  cellValues: Float32Array | null;
}

/** A mesh with few cells instead of one with many. */
export interface CoarseCells {
  /** Counts the coarse meshes. */
  version: number;
  /** Absent if the asker has this version. */
  cells?: VolumeCells;
}

export const kHiddenCell = 0x80000000;
/** A larger mesh has a coarse one beside it, with no more cells than this. */
export const kCoarseCells = 8000;

export function buffersOfVolume({
  vertices,
  cells,
  tags,
  links,
  entries,
  cellValues,
}: VolumeCells): ArrayBuffer[] {
  return [vertices, cells, tags, links, entries, ...(cellValues ? [cellValues] : [])].map(
    ({buffer}) => buffer as ArrayBuffer,
  );
}
