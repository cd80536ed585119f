// Pieces of meshes for tests.
#pragma once

#include <algorithm>
#include <cstdint>

#include "codec/mesh/boundary.h"
#include "simplify/blocks/mesh_piece.h"
#include "tests/support/meshes.h"

namespace qtet::testing {

/// The fields of a grid with cell fields, and quadrics of three numbers, two of them sums.
inline PieceShape shapeOf(const MeshPiece&) {
  LatticeMesh mesh = gridMesh(1, 1);
  addCellFields(mesh);
  return {mesh.fields, 3, 2};
}

/// A grid of n cubes a side with everything that a piece may have.
inline MeshPiece pieceWithAll(int n) {
  LatticeMesh mesh = gridMesh(n, 2);
  addCellFields(mesh);
  MeshPiece out;
  for (VertexId v = 0; v < mesh.points.size(); ++v) {
    out.vertices.push_back(v % 2 == 0 ? 3 * v : newVertex(0, v / 64, v));
    out.quadrics.insert(out.quadrics.end(), {1.0 * v, 2.0 * v, 0.5});
  }
  std::ranges::sort(out.vertices);
  out.points = mesh.points;
  out.values = mesh.values;
  out.missing.resize(mesh.fields.size());
  out.missing[0].resize(mesh.values[0].size());
  for (std::size_t i = 0; i < out.missing[0].size(); i += 3) out.missing[0][i] = 1;
  out.tetrahedra = mesh.tetrahedra;
  for (CellId c = 0; c < mesh.tetrahedra.size(); ++c)
    for (int opposite = 0; opposite < 4; ++opposite)
      if (std::ranges::find(mesh.boundary, cellFace(mesh.tetrahedra[c], opposite)) !=
          mesh.boundary.end())
        out.boundary.push_back({cellFace(mesh.tetrahedra[c], opposite), c});
  for (CellId c = 0; c < mesh.tetrahedra.size(); c += 5)
    out.places.push_back({static_cast<std::uint32_t>(out.places.size()), c, 1, 0});
  return out;
}

}  // namespace qtet::testing
