// The candidates of a vertex that remain after some failed, died or turned out dearer.
#include "simplify/fuse/candidates.h"

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "simplify/mesh/workers.h"

namespace qtet {
namespace {

constexpr VertexId kOwner = 3;

void set(Candidates& candidates, VertexId owner, const std::vector<Candidate>& found) {
  Workers one(1);
  candidates.set(std::span(&owner, 1), std::span(&found, 1), one);
}

Candidates three() {
  Candidates out;
  set(out, kOwner, {{1, 10}, {2, 20}, {3, 30}});
  return out;
}

TEST(Candidates, theDeadDoNotComeBackTheFailedDoAndAreDearer) {
  Candidates candidates = three();
  candidates.fail(kOwner);
  EXPECT_EQ(candidates.best(kOwner)->partner, 20u);
  candidates.drop(kOwner);
  EXPECT_EQ(candidates.best(kOwner)->partner, 30u);
  EXPECT_EQ(candidates.remaining(kOwner).size(), 1u);
  candidates.restart(kOwner);
  ASSERT_EQ(candidates.remaining(kOwner).size(), 2u);
  EXPECT_EQ(candidates.remaining(kOwner)[0].partner, 30u);
  EXPECT_EQ(candidates.remaining(kOwner)[1].partner, 10u);
  EXPECT_FLOAT_EQ(candidates.remaining(kOwner)[1].key, 4);
}

TEST(Candidates, whatIsDearerThanThoughtTakesItsPlaceAmongTheRest) {
  Candidates candidates = three();
  candidates.raise(kOwner, 2.5f);
  EXPECT_EQ(candidates.remaining(kOwner)[0].partner, 20u);
  EXPECT_EQ(candidates.remaining(kOwner)[1].partner, 10u);
}

TEST(Candidates, compactingLosesNoneThatIsAlive) {
  Candidates candidates = three();
  for (VertexId v = 100; v < 5000; ++v) set(candidates, v, {{1, v + 1}});
  candidates.drop(kOwner);
  for (VertexId v = 110; v < 6000; ++v) candidates.forget(v);
  candidates.compact();
  EXPECT_EQ(candidates.remaining(kOwner).size(), 2u);
  EXPECT_EQ(candidates.best(109)->partner, 110u);
  EXPECT_EQ(candidates.best(110), nullptr);
}

TEST(Candidates, noneThatIsDroppedIsMiscountedWhereThreadsDropThoseOfTheirOwnOwners) {
  constexpr VertexId kOwners = 4096;
  // with one more alive than that nothing would be compacted
  constexpr std::size_t kDropped = 100, kEach = 2 * kDropped - 1;
  const std::vector<Candidate> each(kEach, Candidate{1, 0});
  Candidates candidates;
  for (VertexId v = 0; v < kOwners; ++v) set(candidates, v, each);
  Workers workers(4);
  workers.forEach(kOwners, 1, [&](std::size_t, std::size_t v) {
    for (std::size_t i = 0; i < kDropped; ++i) candidates.drop(static_cast<VertexId>(v));
  });
  const Candidate* const before = candidates.remaining(0).data();
  candidates.compact();
  EXPECT_NE(candidates.remaining(0).data(), before);
  EXPECT_EQ(candidates.remaining(kOwners - 1).size(), kEach - kDropped);
}

}  // namespace
}  // namespace qtet
