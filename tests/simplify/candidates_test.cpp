// What is left of a vertex' candidates after some failed, died or turned out dearer.
#include "simplify/candidates.h"

#include <gtest/gtest.h>

#include <array>

namespace qtet {
namespace {

constexpr VertexId kOwner = 3;

Candidates three() {
  Candidates out;
  out.set(kOwner, std::array<Candidate, 3>{{{1, 10}, {2, 20}, {3, 30}}});
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
  for (VertexId v = 100; v < 5000; ++v) candidates.set(v, std::array<Candidate, 1>{{{1, v + 1}}});
  candidates.drop(kOwner);
  for (VertexId v = 110; v < 6000; ++v) candidates.forget(v);
  candidates.compact();
  EXPECT_EQ(candidates.remaining(kOwner).size(), 2u);
  EXPECT_EQ(candidates.best(109)->partner, 110u);
  EXPECT_EQ(candidates.best(110), nullptr);
}

}  // namespace
}  // namespace qtet
