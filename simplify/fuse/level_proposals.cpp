#include "simplify/fuse/level_proposals.h"

#include <algorithm>
#include <cassert>

namespace qtet {
namespace {

// How many entries ahead the memory is asked whether they are locked.
constexpr std::size_t kLocksAhead = 8;

}  // namespace

void LevelProposals::begin(std::span<const QueueEntry> entries) {
  assert(withProposal_.empty() && spare_.empty() && used_ == 0);
  entries_ = entries;
  next_ = first_ = end_ = 0;
  proposalOf_.resize(mesh_.vertexSlots(), nullptr);
}

void LevelProposals::end() {
  for (const VertexId v : withProposal_) proposalOf_[v] = nullptr;
  withProposal_.clear(), spare_.clear();
  used_ = 0;
}

void LevelProposals::comeTo(std::size_t at) {
  assert(at < entries_.size());
  while (first_ < end_ && ahead_[first_ % ahead_.size()].at <= at) ++first_;
  next_ = std::max(next_, at + 1);
  lookAhead();
}

void LevelProposals::lookAhead() {
  while (end_ - first_ < kAhead && addNext()) askMemory();
}

// The next entry that is not locked.
bool LevelProposals::addNext() {
  for (; next_ < entries_.size(); ++next_) {
    if (next_ + kLocksAhead < entries_.size())
      changes_.prefetch(entries_[next_ + kLocksAhead].owner);
    if (!changes_.isLocked(entries_[next_].owner)) break;
  }
  if (next_ == entries_.size()) return false;
  assert(end_ - first_ < kAhead);
  ahead_[end_++ % ahead_.size()] = {next_, entries_[next_].owner, kGhost};
  ++next_;
  return true;
}

// The queue's order has nothing to do with where things lie in memory. So the memory is asked for a
// proposal's data in steps, each of which needs the one before.
void LevelProposals::askMemory() {
  const auto stepsAgo = [this](std::size_t steps) {
    return end_ - first_ > steps ? &ahead_[(end_ - 1 - steps) % ahead_.size()] : nullptr;
  };
  const auto askPlace = [this](VertexId v) {
    mesh_.prefetchVertex(v), cost_.prefetchSlot(v), mesh_.prefetchPoint(v);
  };
  const auto askStar = [this](VertexId v) { mesh_.prefetchStar(v), mesh_.prefetchPlanes(v); };
  if (const Ahead* entry = stepsAgo(0)) candidates_.prefetch(entry->owner), askPlace(entry->owner);
  if (const Ahead* entry = stepsAgo(1))
    candidates_.prefetchBest(entry->owner), mesh_.prefetchList(entry->owner);
  if (Ahead* entry = stepsAgo(3)) {
    askStar(entry->owner), cost_.prefetch(entry->owner);
    if (const Candidate* best = candidates_.best(entry->owner)) {
      entry->partner = best->partner;
      changes_.prefetch(entry->partner), askPlace(entry->partner);
    }
  }
  if (const Ahead* entry = stepsAgo(5); entry && entry->partner != kGhost)
    mesh_.prefetchList(entry->partner), cost_.prefetch(entry->partner);
  if (const Ahead* entry = stepsAgo(6); entry && entry->partner != kGhost) askStar(entry->partner);
}

Proposal& LevelProposals::of(VertexId owner) {
  assert(owner < proposalOf_.size());
  Proposal*& own = proposalOf_[owner];
  if (!own) {
    own = &sparest();
    withProposal_.push_back(owner);
  }
  return *own;
}

// The one that was given back last, since the processor has it near.
Proposal& LevelProposals::sparest() {
  if (spare_.empty() && used_ == proposals_.size()) proposals_.emplace_back();
  assert(used_ <= proposals_.size());
  Proposal& proposal = spare_.empty() ? proposals_[used_++] : *spare_.back();
  if (!spare_.empty()) spare_.pop_back();
  proposal.illegal.clear();
  proposal.partner = kGhost;
  return proposal;
}

void LevelProposals::giveBack(VertexId owner) {
  assert(owner < proposalOf_.size());
  if (!proposalOf_[owner]) return;
  spare_.push_back(proposalOf_[owner]);
  proposalOf_[owner] = nullptr;
}

}  // namespace qtet
