// The mesh that is being measured: a history on its way from the finest level to the coarsest, and
// the search trees of both boundaries.
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simplify/measure/original_samples.h"
#include "simplify/mesh/history_levels.h"
#include "simplify/mesh/triangle_tree.h"

namespace qtet {

/// Reading is safe from any thread between two calls of coarsen().
class MeasuredMesh {
 public:
  /// Moves `levels` to the finest level. That is the original, unless it was reduced from `before`.
  explicit MeasuredMesh(HistoryLevels& levels, const OriginalSamples* before = nullptr);

  [[nodiscard]] const FusionHistory& history() const { return levels_.history(); }
  [[nodiscard]] std::uint32_t level() const { return levels_.level(); }
  /// One level coarser. boundaryTree() searches for nothing until fitTree(). REQUIRES: level() > 0.
  void coarsen();
  void fitTree();

  /// The fusions of the last step.
  [[nodiscard]] std::span<const Fusion> step() const { return step_; }
  /// The fusion of the last step whose star holds the cell, nullptr if there is none. The cell then
  /// is what and where it was before.
  [[nodiscard]] const Fusion* fusionOf(std::uint32_t cell) const;
  /// Whether the cell is what and where it is in the original.
  [[nodiscard]] bool isOriginal(std::uint32_t cell) const {
    assert(cell < lastFusion_.size());
    return lastFusion_[cell] == 0;
  }
  [[nodiscard]] std::span<const std::uint32_t> affected(const Fusion& fusion) const {
    return std::span(history().affectedCells).subspan(fusion.firstAffected, fusion.affectedCount);
  }
  [[nodiscard]] bool isGhost(std::uint32_t cell) const {
    assert(cell < history().cells.size());
    return history().cells[cell][3] == kGhost;
  }

  /// Ghost cells of this level.
  [[nodiscard]] const std::vector<std::uint32_t>& boundary() const { return boundary_; }
  [[nodiscard]] const TriangleTree& boundaryTree() const { return *tree_; }
  /// The boundary of the original: its triangle i is the ghost cell originalBoundary()[i].
  [[nodiscard]] const std::vector<std::uint32_t>& originalBoundary() const {
    return originalBoundary_;
  }
  [[nodiscard]] const TriangleTree& originalTree() const { return *originalTree_; }
  /// The triangles of originalTree() as they were.
  [[nodiscard]] std::span<const TriangleTree::Cell> originalTriangles() const {
    return originalTriangles_;
  }
  /// Index of a ghost cell in originalBoundary().
  [[nodiscard]] std::uint32_t originalTriangle(std::uint32_t ghost) const;

  /// Six times the volume inside this level's boundary, over that of the original; 1 where the
  /// original has none.
  [[nodiscard]] double volumeKept() const;
  /// The diagonal of the original's bounding box, in lattice steps.
  [[nodiscard]] double diagonal() const { return diagonal_; }

 private:
  [[nodiscard]] double volume() const;
  void rebuildTree();

  HistoryLevels& levels_;
  // a cell: index of the last fusion whose star held it, plus 1
  std::vector<std::uint32_t> lastFusion_;
  std::span<const Fusion> step_;  // the fusions of the last step
  std::vector<std::uint32_t> boundary_, originalBoundary_;
  std::vector<TriangleTree::Cell> originalTriangles_;
  std::optional<TriangleTree> tree_, originalTree_;
  double originalVolume_ = 0, diagonal_ = 0;
};

}  // namespace qtet
