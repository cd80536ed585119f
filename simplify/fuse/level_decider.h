// Decides which candidates are fused in a level (ALGORITHM.md, "Levels"): those within its limit,
// cheapest first. Each must be legal, with a star that no other one has changed.
#pragma once

#include <cstddef>

#include "simplify/fuse/fusion_proposer.h"
#include "simplify/fuse/fusion_state.h"
#include "simplify/fuse/level_fusions.h"
#include "simplify/fuse/level_proposals.h"
#include "simplify/fuse/level_queue.h"
#include "simplify/mesh/workers.h"

namespace qtet {

class LevelDecider {
 public:
  /// REQUIRES: all outlive this.
  LevelDecider(FusionState& state, const Workers& workers, const Proposers& proposers)
      : state_(state),
        workers_(workers),
        proposers_(proposers),
        proposals_(state.mesh(), state.cost(), state.candidates(), state.changes()) {}

  /// Decides on the fusions of a level and carries each out, until so many tetrahedra are left or
  /// the queue is through. REQUIRES: both have begun the level, a proposer.
  void run(LevelQueue& queue, LevelFusions& fusions, std::size_t goal);

 private:
  /// Null where the fusion is not legal; that, too, is known only of what costs no more than it
  /// may.
  struct Outcome {
    const Proposal* proposal;
    float cost;
  };
  void process(VertexId owner, LevelQueue& queue, LevelFusions& fusions);
  [[nodiscard]] Outcome propose(VertexId owner, VertexId partner, float most);

  FusionState& state_;
  const Workers& workers_;
  const Proposers& proposers_;
  LevelProposals proposals_;
};

}  // namespace qtet
