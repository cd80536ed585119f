#include "simplify/fuse/level_decider.h"

#include <algorithm>
#include <cassert>

namespace qtet {
namespace {

// A fusion that turns out to cost this much more than its key waits for those that cost less.
constexpr float kDearer = 1.25f;

}  // namespace

void LevelDecider::run(LevelQueue& queue, LevelFusions& fusions, std::size_t goal) {
  assert(fusions.fused().empty());
  assert(!proposers_.empty());
  state_.changes().beginLevel();
  proposals_.begin(queue.entries());
  while (queue.nextKey() <= queue.limit() && state_.mesh().liveTetrahedra() > goal) {
    workers_.throwIfStopped();
    const auto [owner, entry] = queue.pop();
    if (state_.changes().isLocked(owner)) continue;
    if (entry != LevelQueue::kBack) proposals_.comeTo(entry);
    process(owner, queue, fusions);
  }
  proposals_.end();
}

void LevelDecider::process(VertexId owner, LevelQueue& queue, LevelFusions& fusions) {
  assert(state_.mesh().alive(owner) && state_.candidates().best(owner));
  const Candidate candidate = *state_.candidates().best(owner);
  assert(state_.mesh().alive(candidate.partner));  // or the owner would be locked
  if (state_.changes().isLocked(candidate.partner)) return;
  // Dearer than this, it waits for what costs less.
  const float most = std::min(queue.limit(), std::max(kDearer * candidate.key, queue.nextKey()));
  const Outcome outcome = propose(owner, candidate.partner, most);
  if (outcome.cost <= most && outcome.proposal && !fusions.isMet(*outcome.proposal)) {
    assert(outcome.proposal->partner == candidate.partner && !outcome.proposal->isPriceAll);
    fusions.carryOut(*outcome.proposal);
    assert(state_.changes().isLocked(owner) && !state_.mesh().alive(owner));
    proposals_.giveBack(owner);
    return;
  }
  outcome.cost > most ? state_.candidates().raise(owner, outcome.cost)
                      : state_.candidates().fail(owner);
  // It comes back with its best remaining candidate, unless that waits for a later level.
  const Candidate* best = state_.bestAlive(owner);
  if (best && best->key <= queue.limit())
    queue.push({best->key, owner});
  else
    proposals_.giveBack(owner);
}

// The outcome for the owner's best candidate. It is made now, unless the one found in this level
// still holds.
LevelDecider::Outcome LevelDecider::propose(VertexId owner, VertexId partner, float most) {
  assert(owner != partner && !state_.changes().isLocked(partner));
  Proposal& proposal = proposals_.of(owner);
  if (const auto illegal =
          std::ranges::find(proposal.illegal, partner, &Proposal::Illegal::partner);
      illegal != proposal.illegal.end())
    return {nullptr, illegal->price};
  const auto changed = [&](VertexId v) { return state_.changes().since(v, proposal.madeAfter); };
  const auto isWhole = [&] { return std::min(proposal.edgeCost, most) <= proposal.most; };
  const bool holds =
      proposal.partner == partner &&
      (proposal.isPriceAll ? proposal.price > most
                           : isWhole() && std::ranges::none_of(proposal.companions, changed));
  if (!holds && !proposers_[0]->propose(owner, state_.candidates().remaining(owner), most,
                                        state_.changes().now(), proposal))
    return {nullptr, proposal.illegal.back().price};
  assert(proposal.partner == partner && proposal.madeAfter <= state_.changes().now());
  return {&proposal,
          proposal.price > most ? proposal.price : static_cast<float>(proposal.where.cost)};
}

}  // namespace qtet
