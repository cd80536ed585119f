// The proposals of a level. Threads ahead of the one that decides make those for the queue's
// entries; that one itself makes those for what comes back.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "simplify/fuse/candidates.h"
#include "simplify/fuse/fusion_proposer.h"
#include "simplify/fuse/queue_entries.h"

namespace qtet {

/// A fusion that turns out to cost this much more than its key waits for those that cost less.
inline constexpr float kDearer = 1.25f;

/// Worker 0 decides: it walks through the entries, touches vertices, and changes the candidates of
/// the entry that it has come to. Meanwhile the others serve(). Mesh and cost change only between
/// levels.
class LevelProposals {
 public:
  LevelProposals(const FusionMesh& mesh, const FusionCost& cost, const Candidates& candidates,
                 const ChangeTimes& changes)
      : mesh_(mesh), cost_(cost), candidates_(candidates), changes_(changes) {}

  /// A level begins with these entries, sorted, and this limit of its keys. `proposers`: one a
  /// worker. All of them outlive the level. REQUIRES: ChangeTimes::beginLevel.
  void begin(std::span<const QueueEntry> entries, float limit, const Proposers& proposers);
  /// The work of another worker until stop().
  void serve(std::size_t worker);
  void stop() { isOver_.store(true, std::memory_order_relaxed); }
  /// REQUIRES: all others have left serve().
  void end();

  /// Worker 0 has come to this entry, whose owner is not locked. REQUIRES: in order.
  void comeTo(std::size_t at);
  /// The owner's proposal, empty when there is none yet; what another thread makes of the entry in
  /// hand is waited for. It stays where it is until giveBack or end.
  [[nodiscard]] Proposal& of(VertexId owner);
  /// The owner's is not asked for again, nor used.
  void giveBack(VertexId owner);

 private:
  // kClaimed: the entries that a worker has claimed and not made yet, while the memory is asked for
  // their data. kMaxMade: its proposals that are not decided on yet, at most. The more there are,
  // the more are spoilt by fusions of their neighbours.
  static constexpr std::size_t kClaimed = 7, kMaxMade = 32;
  struct Claim {
    std::size_t at = 0;                         // into entries_
    VertexId owner = kGhost, partner = kGhost;  // kGhost: not known yet
  };
  struct alignas(64) Worker {        // in cache lines of its own
    std::deque<Proposal> proposals;  // the first ones are of this level
    std::size_t used = 0;
    std::array<Claim, 8> claims{};             // a ring
    std::size_t first = 0, end = 0;            // of the claims
    std::array<std::size_t, kMaxMade> made{};  // a ring of entries
    std::size_t madeCount = 0;
  };

  bool claim(Worker& worker);
  void claimMore(Worker& worker);
  void askMemory(Worker& worker) const;
  [[nodiscard]] bool makeNext(std::size_t number);
  void put(std::size_t at, Proposal* made) {
    std::atomic_ref(made_[at]).store(made, std::memory_order_release);
  }
  [[nodiscard]] Proposal* make(const Claim& claim, std::size_t worker);
  [[nodiscard]] Proposal* await(std::size_t at);
  [[nodiscard]] Proposal& sparest();
  [[nodiscard]] static Proposal& newOf(Worker& worker);
  [[nodiscard]] static Proposal& emptied(Proposal& proposal);

  const FusionMesh& mesh_;
  const FusionCost& cost_;
  const Candidates& candidates_;
  const ChangeTimes& changes_;
  std::span<const QueueEntry> entries_;
  float limit_ = 0;
  const Proposers* proposers_ = nullptr;
  std::deque<Worker> workers_;
  // by entry, read and written atomically; null while nobody has made it
  std::vector<Proposal*> made_;
  Proposal nothing_;  // of an entry for which there is no proposal
  // Worker 0's.
  std::vector<Proposal*> proposalOf_;  // by vertex
  std::vector<VertexId> withProposal_;
  std::vector<Proposal*> spare_;  // given back
  std::size_t hand_ = 0;          // the entry in hand
  bool isAnothers_ = false;       // who makes its proposal
  bool isFirst_ = false;          // its owner has not been asked for yet
  // entries before it are claimed, or were locked
  alignas(64) std::atomic<std::size_t> claimed_{0};
  alignas(64) std::atomic<std::size_t> reached_{0};  // the entry that worker 0 has come to
  std::atomic<bool> isOver_{false};
};

}  // namespace qtet
