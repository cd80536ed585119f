// What a mesh is counted in.

export interface Counts {
  tetrahedra: number;
  vertices: number;
  boundaryTriangles: number;
}
