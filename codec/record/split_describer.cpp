#include "codec/record/split_describer.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace qtet {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

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
      fusionOf_(history.points.size(), kNone),
      labelOf_(history.cells.size(), kNoLabel) {
  for (std::uint32_t i = 0; i < history.fusions.size(); ++i)
    fusionOf_[history.fusions[i].fused] = i;
}

const Fusion* SplitDescriber::fusionAt(VertexId v) const {
  const std::uint32_t index = fusionOf_[mirror_.vertices()[v]];
  if (index == kNone) return nullptr;
  const Fusion& fusion = history_.fusions[index];
  return history_.levels - fusion.level == mirror_.mesh().level() ? &fusion : nullptr;
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
  for (std::uint32_t i = 0; i < fusion.deletedCount; ++i) {
    const std::uint32_t id = history_.deletedCells[fusion.firstDeleted + i];
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
