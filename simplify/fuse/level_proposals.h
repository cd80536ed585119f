// The proposals of a level that are known and not used yet. It also asks the memory for what the
// proposals of the next entries need.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "simplify/cost/fusion_cost.h"
#include "simplify/fuse/candidates.h"
#include "simplify/fuse/change_times.h"
#include "simplify/fuse/fusion_proposer.h"
#include "simplify/fuse/queue_entries.h"
#include "simplify/mesh/fusion_mesh.h"

namespace qtet {

class LevelProposals {
 public:
  /// REQUIRES: all outlive this.
  LevelProposals(const FusionMesh& mesh, const FusionCost& cost, const Candidates& candidates,
                 const ChangeTimes& changes)
      : mesh_(mesh), cost_(cost), candidates_(candidates), changes_(changes) {}

  /// A level begins with these entries, sorted. They outlive the level. REQUIRES:
  /// ChangeTimes::beginLevel.
  void begin(std::span<const QueueEntry> entries);
  void end();

  /// It is this entry's turn. REQUIRES: in order.
  void comeTo(std::size_t at);
  /// The owner's proposal, empty when there is none yet. It stays where it is until giveBack or
  /// end.
  [[nodiscard]] Proposal& of(VertexId owner);
  /// The owner's is not asked for again, nor used.
  void giveBack(VertexId owner);

 private:
  struct Ahead {
    std::size_t at = 0;  // into entries_
    VertexId owner = kGhost;
    VertexId partner = kGhost;  // kGhost: not known yet
  };
  // Entries whose data the memory is asked for.
  static constexpr std::size_t kAhead = 7;

  void lookAhead();
  [[nodiscard]] bool addNext();
  void askMemory();
  [[nodiscard]] Proposal& sparest();

  const FusionMesh& mesh_;
  const FusionCost& cost_;
  const Candidates& candidates_;
  const ChangeTimes& changes_;
  std::span<const QueueEntry> entries_;
  std::size_t next_ = 0;             // entries before it are in ahead_, were there, or are locked
  std::array<Ahead, 8> ahead_{};     // a ring
  std::size_t first_ = 0, end_ = 0;  // of the ring
  std::deque<Proposal> proposals_;   // the first ones are of this level
  std::size_t used_ = 0;
  std::vector<Proposal*> proposalOf_;  // by vertex
  std::vector<VertexId> withProposal_;
  std::vector<Proposal*> spare_;  // given back
};

}  // namespace qtet
