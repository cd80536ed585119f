// Whether two points of different blocks have the same values, so that nothing is lost where they
// become one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Values are the same within this share of their field's range. Rounding differs by less, a jump
/// between two materials by more.
inline constexpr double kSameValues = 1e-3;

/// The float point fields of a mesh, which must outlive it.
class PointValues {
 public:
  /// `blocks` has the block of each point, 0 for none. Empty: there are no blocks, and all points
  /// agree.
  PointValues(const CellMesh& mesh, std::span<const std::int32_t> blocks);

  /// Whether the points are of one block, or all values that both have are the same. Integers do
  /// not count: they number points, or say what is at a place. A missing value agrees with any.
  [[nodiscard]] bool agree(VertexId a, VertexId b) const;

 private:
  struct Field {
    const MeshField* values;
    double tolerance;
  };

  std::span<const std::int32_t> blocks_;
  std::vector<Field> fields_;
};

}  // namespace qtet
