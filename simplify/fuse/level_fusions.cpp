#include "simplify/fuse/level_fusions.h"

#include <cassert>

namespace qtet {

void LevelFusions::begin(std::uint32_t level) {
  assert(level >= level_);
  level_ = level;
  if (boundary_) boundary_->beginLevel();
  fused_.clear(), links_.clear(), linkEnds_.clear();
}

bool LevelFusions::reachesABox(const Proposal& proposal) const {
  if (beside_.boxes.empty()) return false;
  LatticeBox own{proposal.where.point, proposal.where.point};
  const auto hold = [&](VertexId v) {
    if (v == kGhost) return;
    const LatticePoint& p = state_.mesh().point(v);
    for (std::size_t i = 0; i < 3; ++i)
      own.low[i] = std::min(own.low[i], p[i]), own.high[i] = std::max(own.high[i], p[i]);
  };
  for (const VertexId v : proposal.star.link) hold(v);
  for (const VertexId v : proposal.prey.vertices()) hold(v);
  return std::ranges::any_of(beside_.boxes, [&](const LatticeBox& box) { return meet(own, box); });
}

void LevelFusions::carryOut(const Proposal& proposal) {
  assert(proposal.partner != kGhost && !proposal.isPriceAll);
  assert(!proposal.where.goesOutside || boundary_);
  const std::vector<VertexId>& link = proposal.star.link;
  for (const VertexId v : proposal.prey.vertices()) {
    assert(!state_.changes().isLocked(v));
    state_.changes().touch(v);
  }
  for (const VertexId v : link)
    if (v != kGhost) state_.changes().touch(v);
  state_.changes().next();
  fused_.push_back(static_cast<VertexId>(state_.mesh().vertexSlots()));
  wentOutside_.push_back(proposal.where.goesOutside);
  if (boundary_) boundary_->decideOn(proposal, fused_.back());
  links_.insert(links_.end(), link.begin(), link.end());
  linkEnds_.push_back(links_.size());
  state_.fuse(proposal.prey, proposal.where.point, proposal.star, level_);
}

}  // namespace qtet
