// The size of a mesh.

export interface Counts {
  tetrahedra: number;
  vertices: number;
  boundaryTriangles: number;
}
