#include "simplify/fuse/level_proposals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "simplify/mesh/workers.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

class ALevel : public ::testing::Test {
 protected:
  ALevel() {
    changes_.resize(mesh_.vertexSlots());
    FusionProposer proposer(mesh_, cost_, changes_, FusionLimits{}, FusionPointOptions{});
    Workers one(1);
    std::vector<Candidate> found;
    for (VertexId v = 0; v < mesh_.vertexSlots(); ++v) {
      proposer.candidatesOf(v, found);
      candidates_.set(std::span(&v, 1), std::span(&found, 1), one);
      if (!found.empty()) entries_.push_back({found[0].key, v});
    }
    std::ranges::sort(entries_, [](const QueueEntry& a, const QueueEntry& b) { return b < a; });
    changes_.beginLevel();
    proposals_.begin(entries_);
  }

  LatticeMesh lattice_ = testing::gridMesh(4, 1);
  FusionMesh mesh_{lattice_};
  FusionCost cost_{mesh_, lattice_, {}};
  ChangeTimes changes_;
  Candidates candidates_;
  std::vector<QueueEntry> entries_;
  LevelProposals proposals_{mesh_, cost_, candidates_, changes_};
};

TEST_F(ALevel, anOwnersProposalStaysUntilItIsGivenBack) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const VertexId owner = entries_[i].owner;
    proposals_.comeTo(i);
    Proposal& proposal = proposals_.of(owner);
    EXPECT_EQ(proposal.partner, kGhost);
    proposal.partner = owner;
    EXPECT_EQ(&proposals_.of(owner), &proposal);
    if (i % 2 == 0) continue;
    proposals_.giveBack(owner);
    EXPECT_EQ(proposals_.of(owner).partner, kGhost);
    proposals_.giveBack(owner);
  }
  for (std::size_t i = 0; i < entries_.size(); i += 2)
    EXPECT_EQ(proposals_.of(entries_[i].owner).partner, entries_[i].owner);
}

TEST_F(ALevel, anotherLevelBeginsWithoutProposals) {
  proposals_.comeTo(0);
  proposals_.of(entries_[0].owner).partner = 7;
  proposals_.end();
  proposals_.begin(entries_);
  proposals_.comeTo(0);
  EXPECT_EQ(proposals_.of(entries_[0].owner).partner, kGhost);
}

/// Entries that a fusion of the level has touched are passed over, also those just looked at.
TEST_F(ALevel, lockedEntriesMayLieAnywhere) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (changes_.isLocked(entries_[i].owner)) continue;
    proposals_.comeTo(i);
    for (std::size_t j = i + 1; j < std::min(i + 6, entries_.size()); j += 2)
      changes_.touch(entries_[j].owner);
    changes_.next();
    EXPECT_EQ(proposals_.of(entries_[i].owner).partner, kGhost);
  }
}

}  // namespace
}  // namespace qtet
