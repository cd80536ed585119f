// Proposals that other threads make for a level are those that the deciding one would make.
#include "simplify/fuse/level_proposals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "simplify/mesh/workers.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

class ALevel : public ::testing::TestWithParam<int> {
 protected:
  static constexpr float kLimit = std::numeric_limits<float>::infinity();

  ALevel() {
    changes_.resize(mesh_.vertexSlots());
    for (std::size_t i = 0; i < workers_.count(); ++i) proposers_.push_back(newProposer());
    Workers one(1);
    std::vector<Candidate> found;
    for (VertexId v = 0; v < mesh_.vertexSlots(); ++v) {
      proposers_[0]->candidatesOf(v, found);
      candidates_.set(std::span(&v, 1), std::span(&found, 1), one);
      if (!found.empty()) entries_.push_back({found[0].key, v});
    }
    std::ranges::sort(entries_, [](const QueueEntry& a, const QueueEntry& b) { return b < a; });
  }

  [[nodiscard]] std::unique_ptr<FusionProposer> newProposer() const {
    return std::make_unique<FusionProposer>(mesh_, cost_, changes_, band_, FusionLimits{},
                                            FusionPointOptions{});
  }
  /// Worker 0 walks through the entries that are not locked and calls decide(owner, its proposal)
  /// for each; as in a level, others serve meanwhile.
  template <class Decide>
  void walk(const Decide& decide) {
    changes_.beginLevel();
    proposals_.begin(entries_, kLimit, proposers_);
    workers_.beside(
        [this](std::size_t worker) { proposals_.serve(worker); },
        [&] {
          for (std::size_t i = 0; i < entries_.size(); ++i) {
            const VertexId owner = entries_[i].owner;
            if (changes_.isLocked(owner) || changes_.isLocked(candidates_.best(owner)->partner))
              continue;
            proposals_.comeTo(i);
            decide(owner, proposals_.of(owner));
          }
          proposals_.stop();
        });
    proposals_.end();
  }

  LatticeMesh lattice_ = testing::gridMesh(8, 1);
  FusionMesh mesh_{lattice_};
  FusionCost cost_{mesh_, lattice_, {}};
  ChangeTimes changes_;
  BandNodes band_;
  Candidates candidates_;
  Workers workers_{GetParam()};
  Proposers proposers_;
  std::vector<QueueEntry> entries_;
  LevelProposals proposals_{mesh_, cost_, candidates_, changes_};
};

TEST_P(ALevel, proposalsAreWhatTheOneThatDecidesWouldMake) {
  const auto alone = newProposer();
  std::size_t made = 0, asked = 0;
  for (int round = 0; round < 3; ++round)
    walk([&](VertexId owner, const Proposal& proposal) {
      ++asked;
      if (proposal.partner == kGhost) return;  // nobody came before, or the best one is not legal
      ++made;
      Proposal expected;
      auto rest = candidates_.remaining(owner);
      while (rest[0].partner != proposal.partner) rest = rest.subspan(1);
      ASSERT_TRUE(alone->propose(owner, rest, std::min(kLimit, kDearer * rest[0].key),
                                 changes_.now(), expected));
      EXPECT_EQ(proposal.price, expected.price);
      EXPECT_EQ(proposal.isPriceAll, expected.isPriceAll);
      if (proposal.isPriceAll) return;
      EXPECT_EQ(proposal.most, expected.most);
      EXPECT_EQ(proposal.prey.vertex, expected.prey.vertex);
      EXPECT_EQ(proposal.where.point, expected.where.point);
      EXPECT_EQ(proposal.star.affected, expected.star.affected);
      EXPECT_EQ(proposal.star.deleted, expected.star.deleted);
      EXPECT_EQ(proposal.companions, expected.companions);
      EXPECT_EQ(proposal.tetrahedra, expected.tetrahedra);
    });
  EXPECT_EQ(asked, 3 * entries_.size());
  EXPECT_TRUE(workers_.count() > 1 || made == 0)
      << "who decides makes its own when it is known what it may cost";
}

TEST_P(ALevel, whatIsMadeBeforeATouchIsSeenToBeOld) {
  walk([&](VertexId owner, const Proposal& proposal) {
    EXPECT_LE(proposal.madeAfter, changes_.now());
    if (proposal.partner != kGhost && !proposal.isPriceAll) {
      for (const VertexId v : proposal.star.link)  // its own star is nobody else's in this level
        if (v != kGhost) changes_.touch(v);
      for (const VertexId v : proposal.prey.vertices()) changes_.touch(v);
    }
    changes_.touch(owner);
    changes_.next();
    EXPECT_TRUE(changes_.since(owner, proposal.madeAfter));
  });
}

TEST_P(ALevel, aLevelMayEndBeforeItsEntriesDo) {
  changes_.beginLevel();
  proposals_.begin(entries_, kLimit, proposers_);
  workers_.beside([this](std::size_t worker) { proposals_.serve(worker); },
                  [&] {
                    proposals_.comeTo(0);
                    (void)proposals_.of(entries_[0].owner);
                    proposals_.stop();
                  });
  proposals_.end();
  std::size_t asked = 0;
  walk([&](VertexId, const Proposal&) { ++asked; });
  EXPECT_EQ(asked, entries_.size());
}

TEST_P(ALevel, aProposalThatIsGivenBackServesAgain) {
  walk([&](VertexId owner, Proposal& proposal) {
    EXPECT_EQ(&proposals_.of(owner), &proposal);
    proposal.illegal.push_back({1, 2});
    proposals_.giveBack(owner);
    EXPECT_TRUE(proposals_.of(owner).illegal.empty());
  });
}

INSTANTIATE_TEST_SUITE_P(LevelProposals, ALevel, ::testing::Values(1, 2, 5),
                         [](const auto& threads) { return std::to_string(threads.param); });

}  // namespace
}  // namespace qtet
