// Finds the point and cell of a log for each point and cell of a mesh file: same lattice places,
// same connectivity, whatever the numbering.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/error.h"

namespace qtet {

struct MeshMatch {
  std::vector<VertexId> points;    ///< the log's point of each point of the mesh
  std::vector<CellId> tetrahedra;  ///< likewise
};

/// Matches exactly: every point by its lattice place, points that share a place by the cells that
/// hold them, every cell by its vertices. The order of a cell's vertices does not matter. Errors:
/// bad-value (other counts; a point or cell that the log has not, named; twins that nothing tells
/// apart).
[[nodiscard]] Result<MeshMatch> matchMesh(const LatticeMesh& mesh,
                                          std::span<const LatticePoint> logPoints,
                                          std::span<const Tetrahedron> logCells);

}  // namespace qtet
