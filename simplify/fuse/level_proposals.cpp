#include "simplify/fuse/level_proposals.h"

#include <algorithm>
#include <cassert>

#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

// How many entries ahead the memory is asked whether they are locked.
constexpr std::size_t kLocksAhead = 8;

}  // namespace

void LevelProposals::begin(std::span<const QueueEntry> entries, float limit,
                           const Proposers& proposers) {
  entries_ = entries, limit_ = limit, proposers_ = &proposers;
  workers_.resize(proposers.size());
  for (Worker& worker : workers_) worker.first = worker.end = worker.madeCount = 0;
  made_.assign(proposers.size() > 1 ? entries.size() : 0, nullptr);
  proposalOf_.resize(mesh_.vertexSlots(), nullptr);
  claimed_ = reached_ = 0;
  isFirst_ = false;
  isOver_ = false;
}

void LevelProposals::end() {
  for (const VertexId v : withProposal_) proposalOf_[v] = nullptr;
  withProposal_.clear(), spare_.clear();
  for (Worker& worker : workers_) worker.used = 0;
}

void LevelProposals::serve(std::size_t worker) {
  for (SpinWait waiting; !isOver_.load(std::memory_order_relaxed);) {
    if (makeNext(worker))
      waiting = {};
    else
      waiting.wait();
  }
}

// Makes a proposal for the next entry that the worker has claimed. False where there is none, or
// too many are made already.
bool LevelProposals::makeNext(std::size_t number) {
  Worker& worker = workers_[number];
  claimMore(worker);
  if (worker.first == worker.end) return false;
  std::size_t& earlier = worker.made[worker.madeCount % kMaxMade];
  if (worker.madeCount >= kMaxMade && earlier >= reached_.load(std::memory_order_relaxed))
    return false;
  const Claim& claim = worker.claims[worker.first++ % worker.claims.size()];
  earlier = claim.at, ++worker.madeCount;
  try {
    put(claim.at, make(claim, number));
  } catch (
      // who waits for this one, or for another one of the worker's claims, must not wait for ever
      ...) {
    put(claim.at, &nothing_);
    for (; worker.first != worker.end; ++worker.first)
      put(worker.claims[worker.first % worker.claims.size()].at, &nothing_);
    throw;
  }
  return true;
}

void LevelProposals::claimMore(Worker& worker) {
  while (worker.end - worker.first < kClaimed && claim(worker)) askMemory(worker);
}

// The next entry that is not locked.
bool LevelProposals::claim(Worker& worker) {
  std::size_t first = claimed_.load(std::memory_order_relaxed), at;
  do {
    for (at = first; at < entries_.size(); ++at) {
      if (at + kLocksAhead < entries_.size()) changes_.prefetch(entries_[at + kLocksAhead].owner);
      if (!changes_.isLocked(entries_[at].owner)) break;
    }
  } while (!claimed_.compare_exchange_weak(first, std::min(at + 1, entries_.size()),
                                           std::memory_order_relaxed));
  if (at == entries_.size()) return false;
  worker.claims[worker.end++ % worker.claims.size()] = {at, entries_[at].owner, kGhost};
  return true;
}

// The queue's order has nothing to do with where things lie in memory. So the memory is asked for a
// proposal's data in steps, each of which needs the one before.
void LevelProposals::askMemory(Worker& worker) const {
  const auto stepsAgo = [&](std::size_t steps) {
    return worker.end - worker.first > steps
               ? &worker.claims[(worker.end - 1 - steps) % worker.claims.size()]
               : nullptr;
  };
  const auto askPlace = [this](VertexId v) {
    mesh_.prefetchVertex(v), cost_.prefetchSlot(v), mesh_.prefetchPoint(v);
  };
  const auto askStar = [this](VertexId v) { mesh_.prefetchStar(v), mesh_.prefetchPlanes(v); };
  if (const Claim* claim = stepsAgo(0)) candidates_.prefetch(claim->owner), askPlace(claim->owner);
  if (const Claim* claim = stepsAgo(1))
    candidates_.prefetchBest(claim->owner), mesh_.prefetchList(claim->owner);
  if (Claim* claim = stepsAgo(3)) {
    askStar(claim->owner), cost_.prefetch(claim->owner);
    if (const Candidate* best = candidates_.best(claim->owner)) {
      claim->partner = best->partner;
      changes_.prefetch(claim->partner), askPlace(claim->partner);
    }
  }
  if (const Claim* claim = stepsAgo(5); claim && claim->partner != kGhost)
    mesh_.prefetchList(claim->partner), cost_.prefetch(claim->partner);
  if (const Claim* claim = stepsAgo(6); claim && claim->partner != kGhost) askStar(claim->partner);
}

void LevelProposals::comeTo(std::size_t at) {
  assert(at < entries_.size() && at >= reached_.load(std::memory_order_relaxed));
  hand_ = at, isFirst_ = true;
  reached_.store(at, std::memory_order_relaxed);
  Worker& own = workers_[0];
  const auto next = [&own] { return own.claims[own.first % own.claims.size()].at; };
  while (own.first < own.end && next() < at) ++own.first;  // locked meanwhile
  claimMore(own);
  isAnothers_ = own.first == own.end || next() != at;
  if (!isAnothers_) ++own.first;
}

Proposal* LevelProposals::make(const Claim& claim, std::size_t worker) {
  const std::uint32_t now = changes_.now();
  auto rest = candidates_.remaining(claim.owner);
  if (changes_.isLocked(claim.owner) || rest.empty() || changes_.isLocked(rest[0].partner))
    return &nothing_;
  Proposal& proposal = newOf(workers_[worker]);
  // Where the best is not legal, the next one is wanted soon.
  for (; !rest.empty() && rest[0].key <= limit_; rest = rest.subspan(1)) {
    if (!mesh_.alive(rest[0].partner) || changes_.isLocked(rest[0].partner)) break;
    // No dearer than one thread would go on with at once: later the owner's other candidates are
    // not what they are now.
    const float most = std::min(limit_, kDearer * rest[0].key);
    if ((*proposers_)[worker]->propose(claim.owner, rest, most, now, proposal)) break;
  }
  return &proposal;
}

// While another thread makes it, worker 0 makes others.
Proposal* LevelProposals::await(std::size_t at) {
  for (SpinWait waiting;;) {
    if (Proposal* made = std::atomic_ref(made_[at]).load(std::memory_order_acquire)) return made;
    if (makeNext(0))
      waiting = {};
    else
      waiting.wait();
  }
}

Proposal& LevelProposals::newOf(Worker& worker) {
  if (worker.proposals.size() == worker.used) worker.proposals.emplace_back();
  return emptied(worker.proposals[worker.used++]);
}

Proposal& LevelProposals::emptied(Proposal& proposal) {
  proposal.illegal.clear();
  proposal.partner = kGhost;
  return proposal;
}

// An entry's owner has none when it is come to, and comes back only afterwards: what is known is
// not looked up.
Proposal& LevelProposals::of(VertexId owner) {
  const bool isFirst = isFirst_ && owner == entries_[hand_].owner;
  isFirst_ = isFirst_ && !isFirst;
  Proposal* own = !isFirst ? proposalOf_[owner] : isAnothers_ ? await(hand_) : nullptr;
  if (!isFirst && own) return *own;
  if (!own || own == &nothing_) own = &sparest();
  withProposal_.push_back(owner);
  return *(proposalOf_[owner] = own);
}

// The one that was given back last, since the processor has it near.
Proposal& LevelProposals::sparest() {
  if (spare_.empty()) return newOf(workers_[0]);
  Proposal& proposal = *spare_.back();
  spare_.pop_back();
  return emptied(proposal);
}

void LevelProposals::giveBack(VertexId owner) {
  if (!proposalOf_[owner]) return;
  spare_.push_back(proposalOf_[owner]);
  proposalOf_[owner] = nullptr;
}

}  // namespace qtet
