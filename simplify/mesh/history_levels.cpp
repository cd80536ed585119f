#include "simplify/mesh/history_levels.h"

#include <algorithm>
#include <cassert>

namespace qtet {

HistoryLevels::HistoryLevels(FusionHistory& history) : history_(history) {
  assert(history.affectedLabels.size() == history.affectedCells.size());
  assert(history.live.size() == history.cells.size());
  const std::vector<Fusion>& fusions = history.fusions;
  assert(std::ranges::is_sorted(fusions, {}, &Fusion::level));
  for (std::uint32_t set = 0; set <= history.levels; ++set)
    firstFusion_.push_back(static_cast<std::size_t>(
        std::ranges::lower_bound(fusions, set, {}, &Fusion::level) - fusions.begin()));
}

std::span<const Fusion> HistoryLevels::fusionsInto(std::uint32_t level) const {
  assert(level < finest());
  const std::size_t set = finest() - 1 - level;
  return std::span(history_.fusions)
      .subspan(firstFusion_[set], firstFusion_[set + 1] - firstFusion_[set]);
}

void HistoryLevels::refine() {
  assert(level_ < finest());
  // independent of one another: any order
  for (const Fusion& fusion : fusionsInto(level_)) undo(fusion);
  ++level_;
}

void HistoryLevels::coarsen() {
  assert(level_ > 0);
  --level_;
  for (const Fusion& fusion : fusionsInto(level_)) redo(fusion);
}

void HistoryLevels::moveTo(std::uint32_t level) {
  assert(level <= finest());
  while (level_ < level) refine();
  while (level_ > level) coarsen();
}

void HistoryLevels::forgetCoarser() {
  const std::uint32_t kept = finest() - level_;
  history_.fusions.resize(firstFusion_[kept]);
  firstFusion_.resize(kept + 1);
  std::size_t affected = 0, deleted = 0;
  for (const Fusion& f : history_.fusions) {
    affected = std::max<std::size_t>(affected, f.firstAffected + f.affectedCount);
    deleted = std::max<std::size_t>(deleted, f.firstDeleted + f.deletedCount);
  }
  history_.affectedCells.resize(affected);
  history_.affectedLabels.resize(affected);
  history_.deletedCells.resize(deleted);
  assert(history_.fusions.empty() || history_.fusions.back().level < kept);
  history_.levels = kept;
  level_ = 0;
}

void HistoryLevels::undo(const Fusion& fusion) {
  assert(fusion.firstAffected + fusion.affectedCount <= history_.affectedCells.size());
  assert(fusion.firstDeleted + fusion.deletedCount <= history_.deletedCells.size());
  for (std::size_t i = fusion.firstAffected; i < fusion.firstAffected + fusion.affectedCount; ++i)
    std::ranges::replace(history_.cells[history_.affectedCells[i]], fusion.fused,
                         fusion.prey[history_.affectedLabels[i]]);
  for (std::size_t i = fusion.firstDeleted; i < fusion.firstDeleted + fusion.deletedCount; ++i) {
    assert(!history_.live[history_.deletedCells[i]]);
    history_.live[history_.deletedCells[i]] = 1;
  }
}

void HistoryLevels::redo(const Fusion& fusion) {
  for (std::size_t i = fusion.firstAffected; i < fusion.firstAffected + fusion.affectedCount; ++i)
    std::ranges::replace(history_.cells[history_.affectedCells[i]],
                         fusion.prey[history_.affectedLabels[i]], fusion.fused);
  for (std::size_t i = fusion.firstDeleted; i < fusion.firstDeleted + fusion.deletedCount; ++i) {
    assert(history_.live[history_.deletedCells[i]]);
    history_.live[history_.deletedCells[i]] = 0;
  }
}

}  // namespace qtet
