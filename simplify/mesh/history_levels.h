// Every level of a fusion history as a mesh, without decoding a log: fusions undone and done again,
// one level at a time, in place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/record/fusion_history.h"

namespace qtet {

/// A history that stands at one of its levels: `history().cells` and `live` are that level's mesh.
/// Levels are counted as in a log: 0 is the base mesh, `finest()` the input's mesh. The history
/// must outlive this; it must stand at level 0 again before it is encoded.
class HistoryLevels {
 public:
  /// Begins at level 0. REQUIRES: a history as a simplifier leaves it, its fusions ordered by
  /// level.
  explicit HistoryLevels(FusionHistory& history);

  [[nodiscard]] const FusionHistory& history() const { return history_; }
  [[nodiscard]] std::uint32_t level() const { return level_; }
  [[nodiscard]] std::uint32_t finest() const { return history_.levels; }
  /// The fusions that lead from level + 1 to `level`, as a run of history().fusions. REQUIRES:
  /// level < finest().
  [[nodiscard]] std::span<const Fusion> fusionsInto(std::uint32_t level) const;

  /// One level finer. REQUIRES: level() < finest().
  void refine();
  /// One level coarser. REQUIRES: level() > 0.
  void coarsen();
  /// To any level. REQUIRES: level <= finest().
  void moveTo(std::uint32_t level);

  /// Makes the level at which the history stands its base mesh: what is coarser is forgotten, and
  /// the level's number becomes 0.
  void forgetCoarser();

 private:
  void undo(const Fusion& fusion);
  void redo(const Fusion& fusion);

  FusionHistory& history_;
  // of each independent set, in the order of doing, and the end
  std::vector<std::size_t> firstFusion_;
  std::uint32_t level_ = 0;
};

}  // namespace qtet
