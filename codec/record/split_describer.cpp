#include "codec/record/split_describer.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "codec/coding/prefetch.h"

namespace qtet {
namespace {

// Numbers the prey vertices in order of first appearance along the link's traversal.
void number(const Link& link, Fusion& fusion, RecordTruth& truth) {
  std::array<std::uint8_t, 4> now{kNoLabel, kNoLabel, kNoLabel, kNoLabel};
  std::uint8_t next = 0;
  for (const std::uint32_t f : link.traversal())
    if (std::uint8_t& n = now[truth.labels[f]]; n == kNoLabel) n = next++;
  for (std::uint8_t& n : now)
    if (n == kNoLabel) n = next++;
  for (std::uint8_t& label : truth.labels) label = now[label];
  const auto prey = fusion.prey;
  for (std::size_t i = 0; i < fusion.k; ++i) fusion.prey[now[i]] = prey[i];
  truth.near = now[0];
}

}  // namespace

SplitDescriber::SplitDescriber(const FusionHistory& history, const MirrorMesh& mirror)
    : history_(history),
      mirror_(mirror),
      waiting_(history.points.size()),
      labelOf_(history.cells.size(), kNoLabel) {
  for (std::uint32_t i = 0; i < history.fusions.size(); ++i)
    waiting_[history.fusions[i].fused] = {i, history.levels - history.fusions[i].level};
}

void SplitDescriber::place(VertexId slot) {
  assert(slot <= next_.size());
  if (slot == next_.size()) next_.emplace_back();
  next_[slot] = waiting_[mirror_.vertices()[slot]];
}

// The splits of a level lie scattered in memory. The data of each are asked for in steps, since a
// step reads what the one before it asked for.
void SplitDescriber::lookAhead(VertexId v) {
  if (!kPrefetchIsFree) return;
  const std::uint32_t level = mirror_.mesh().level();
  if (seenLevel_ != level) seenLevel_ = level, seen_ = v + 1, ahead_ = {};
  while (ahead_.size() > 0 && ahead_[0] <= v) ahead_.pop();
  for (; seen_ < mirror_.mesh().levelVertices() && ahead_.size() < Ahead::kMax; ++seen_)
    if (next_[seen_].level == level) {
      ahead_.push(seen_);
      prefetch(&history_.fusions[next_[seen_].fusion]);
      mirror_.mesh().expect(seen_);
    }
  if (ahead_.size() > 6) expectLists(ahead_[6]);
  if (ahead_.size() > 4) expectCells(ahead_[4]);
  if (ahead_.size() > 2) expectCorners(ahead_[2]);
}

void SplitDescriber::expectLists(VertexId v) const {
  const Fusion& fusion = history_.fusions[next_[v].fusion];
  prefetchAll(affectedBy(fusion));
  prefetchAll(deletedBy(fusion));
  prefetch(history_.affectedLabels.data() + fusion.firstAffected);
}

void SplitDescriber::expectCells(VertexId v) const {
  const Fusion& fusion = history_.fusions[next_[v].fusion];
  for (const std::uint32_t cell : affectedBy(fusion)) prefetch(&labelOf_[cell]);
  for (const std::uint32_t cell : deletedBy(fusion)) prefetch(&history_.cells[cell]);
  for (std::size_t i = 0; i < fusion.k; ++i)
    prefetch(&history_.points[fusion.prey[i]]), prefetch(&waiting_[fusion.prey[i]]);
  mirror_.expect(v);
}

void SplitDescriber::expectCorners(VertexId v) const {
  for (const std::uint32_t cell : deletedBy(history_.fusions[next_[v].fusion]))
    for (const VertexId corner : history_.cells[cell]) mirror_.expectSlot(corner);
}

bool SplitDescriber::describe(VertexId v, const Link& link, Fusion& fusion, RecordTruth& truth) {
  assert(link.triangles().size() == mirror_.mesh().star(v).size());
  truth.k = fusion.k;
  truth.placement = fusion.placement;
  if (!labels(v, fusion, truth)) return false;
  number(link, fusion, truth);
  for (std::size_t i = 0; i < fusion.k; ++i) truth.points[i] = history_.points[fusion.prey[i]];
  return deleted(link, fusion, truth);
}

bool SplitDescriber::labels(VertexId v, const Fusion& fusion, RecordTruth& truth) {
  for (std::uint32_t i = 0; i < fusion.affectedCount; ++i)
    labelOf_[history_.affectedCells[fusion.firstAffected + i]] =
        history_.affectedLabels[fusion.firstAffected + i];
  const std::span<const CellRef> star = mirror_.mesh().star(v);
  truth.labels.resize(star.size());
  bool whole = star.size() == fusion.affectedCount;
  for (std::size_t f = 0; f < star.size(); ++f) {
    truth.labels[f] = std::exchange(labelOf_[mirror_.cellOf(star[f])], kNoLabel);
    whole &= truth.labels[f] < fusion.k;
  }
  return whole;
}

bool SplitDescriber::deleted(const Link& link, const Fusion& fusion, RecordTruth& truth) {
  deleted_.clear();
  for (const std::uint32_t id : deletedBy(fusion)) {
    const auto& cell = history_.cells[id];
    LocalCell local{};
    for (std::size_t j = 0; j < 4; ++j) {
      const auto prey = std::find(fusion.prey.begin(), fusion.prey.begin() + fusion.k, cell[j]) -
                        fusion.prey.begin();
      const bool isPrey = prey < fusion.k;
      if (!isPrey && !mirror_.has(cell[j])) return false;
      local[j] = isPrey ? kPreyBit | static_cast<LocalVertex>(prey)
                        : link.localOf(mirror_.slotOf(cell[j]));
      if (local[j] == kNoNeighbour) return false;
    }
    truth.deleted.push_back(sorted(local));
    deleted_.emplace_back(truth.deleted.back(), id);
  }
  std::ranges::sort(deleted_);
  std::ranges::sort(truth.deleted);
  return true;
}

const std::vector<std::uint32_t>& SplitDescriber::restored(const Split& split) {
  restored_.clear();
  for (const LocalCell& cell : split.deleted)
    restored_.push_back(std::ranges::lower_bound(deleted_, std::pair{sorted(cell), 0u})->second);
  return restored_;
}

}  // namespace qtet
