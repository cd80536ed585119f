#include "simplify/fuse/level_fusions.h"

#include <cassert>

namespace qtet {

void LevelFusions::begin(std::uint32_t level) {
  assert(level >= level_);
  level_ = level;
  if (boundary_) boundary_->beginLevel();
  fused_.clear(), links_.clear(), linkEnds_.clear();
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
