// Steps whose points or cells stand in another order than those of the first step.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The order of a series' first step. It keeps what it has sorted for the next step. REQUIRES: the
/// mesh outlives it and does not change.
class StepOrder {
 public:
  explicit StepOrder(const CellMesh& rest) : rest_(rest) {}

  /// Puts the step's points, cells and values into the order of the first step, if it has the same
  /// cells. Points are found by their exact places, where each has a place of its own; elsewhere
  /// they keep their numbers. Tetrahedra may list their corners in any order. False: it has other
  /// cells, and is left as it was.
  [[nodiscard]] bool restore(CellMesh& step);

  /// Whether the step's points are those of the first one in another order, while its cells name
  /// the same numbers. Its cells are torn then. A body that turns into itself keeps its edges'
  /// lengths, and is not torn. REQUIRES: as many points, and haveSameCells.
  [[nodiscard]] bool isTorn(const CellMesh& step);

 private:
  using Names = std::vector<VertexId>;

  void sortPoints();
  [[nodiscard]] std::optional<Names> namesByPlace(std::span<const Position> points);
  [[nodiscard]] std::optional<std::vector<std::size_t>> cellsByPoints(const CellMesh& step,
                                                                      const Names& names);

  const CellMesh& rest_;
  Names sorted_;           ///< its points by their places; empty: not sorted yet
  bool isUnique_ = false;  ///< no two of them are at one place
};

}  // namespace qtet
