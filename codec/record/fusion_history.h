// A simplifier's fusions, in its own numbering: all that an encoder needs to write the way back.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/mesh/mesh.h"
#include "codec/mesh/placement.h"

namespace qtet {

/// One fusion: k prey vertices became `fused`, which lies as `placement` says; prey[0] is the near
/// vertex.
struct Fusion {
  std::uint8_t k = 2;
  Placement placement = Placement::kFree;
  std::uint32_t level = 0;  ///< 0 = the first independent set fused, that is, the finest level
  VertexId fused = 0;
  std::array<VertexId, 4> prey{};
  std::uint64_t firstAffected = 0;  ///< into affectedCells / affectedLabels
  std::uint64_t firstDeleted = 0;   ///< into deletedCells
  std::uint32_t affectedCount = 0, deletedCount = 0;
};

/// Cells are the input's tetrahedra followed by its boundary triangles as (a, b, c, kGhost).
/// REQUIRES within one level no prey vertex in the star of another fusion of that level; within the
/// list, order of doing.
struct FusionHistory {
  Lattice lattice;
  std::vector<FieldInfo> fields;
  std::vector<LatticePoint> points;  ///< of every vertex that ever lived
  /// Per field, components a vertex. Cell fields have the input's, components a tetrahedron.
  std::vector<std::vector<std::int32_t>> values;
  /// As they are now, or as they were when deleted.
  std::vector<std::array<VertexId, 4>> cells;
  std::vector<std::uint8_t> live;  ///< one a cell
  std::vector<Fusion> fusions;
  std::vector<std::uint32_t> affectedCells;
  std::vector<std::uint8_t> affectedLabels;  ///< index into prey
  std::vector<std::uint32_t> deletedCells;
  std::uint32_t levels = 0;
};

}  // namespace qtet
