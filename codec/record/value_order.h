// The order in which a log brings its vertices and tetrahedra, and what their values are predicted
// from: all that fields need of the geometry.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/mesh/mesh.h"
#include "codec/record/base_coder.h"
#include "codec/record/cell_values.h"
#include "codec/record/point_values.h"

namespace qtet {

/// Vertices and tetrahedra are those of a history (FusionHistory).
struct ValueOrder {
  std::vector<BaseBirth> baseBirths;
  std::vector<VertexId> baseVertices;  ///< by slot of the base mesh
  PointAncestry points{true};
  CellAncestry cells;
  std::vector<std::array<VertexId, 4>> prey;  ///< of each birth, in the order of coding
  std::vector<VertexId> fused;                ///< of each birth: the vertex that splits
  std::vector<std::uint32_t> tetrahedra;      ///< by slot of the last level
  /// Births and tetrahedra before chunk i, and of all chunks.
  std::vector<std::uint32_t> chunkBirths{0}, chunkCells{0};

  [[nodiscard]] std::size_t chunks() const { return chunkBirths.size() - 1; }
  /// Vertex slots of the last level.
  [[nodiscard]] std::size_t vertices() const {
    return points.births().empty()
               ? baseVertices.size()
               : points.births().back().firstNew + points.births().back().k - 1u;
  }
};

}  // namespace qtet
