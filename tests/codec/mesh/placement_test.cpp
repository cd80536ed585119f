#include "codec/mesh/placement.h"

#include <gtest/gtest.h>

#include "proto/limits.h"

namespace qtet {
namespace {

constexpr std::int32_t kFar = (1 << kMaxPositionBits) - 1;

TEST(Placement, theMiddleIsTheMeanRoundedDown) {
  EXPECT_EQ(middle(std::array{LatticePoint{0, 1, 2}, LatticePoint{1, 1, 5}}),
            (LatticePoint{0, 1, 3}));
  EXPECT_EQ(middle(std::array{LatticePoint{0, 0, 1}, LatticePoint{0, 1, 1}, LatticePoint{2, 1, 1}}),
            (LatticePoint{0, 0, 1}));
  EXPECT_EQ(middle(std::array{LatticePoint{0, 4, 7}, LatticePoint{0, 4, 7}, LatticePoint{0, 4, 7},
                              LatticePoint{3, 0, 6}}),
            (LatticePoint{0, 3, 6}));
}

TEST(Placement, theMiddleDoesNotDependOnTheOrder) {
  const LatticePoint a{3, 900, 17}, b{8, 1, 18}, c{2, 77, 18};
  EXPECT_EQ(middle(std::array{a, b, c}), middle(std::array{c, a, b}));
  EXPECT_EQ(middle(std::array{a, b}), middle(std::array{b, a}));
}

TEST(Placement, aQuarterIsRoundedToTheNearestHalvesUp) {
  EXPECT_EQ(quarter({0, 0, 0}, {4, 8, 12}), (LatticePoint{1, 2, 3}));
  EXPECT_EQ(quarter({0, 0, 0}, {1, 2, 3}), (LatticePoint{0, 1, 1}));  // 1/4, 2/4, 3/4
  EXPECT_EQ(quarter({4, 4, 4}, {3, 2, 1}), (LatticePoint{4, 4, 3}));  // 15/4, 14/4, 13/4
}

TEST(Placement, theFarCornerOfTheLargestLatticeFits) {
  const LatticePoint far{kFar, kFar, kFar};
  EXPECT_EQ(middle(std::array{far, far, far, far}), far);
  EXPECT_EQ(quarter(far, far), far);
  EXPECT_EQ(quarter(far, {0, kFar, kFar}),
            (LatticePoint{kFar - (1 << (kMaxPositionBits - 2)), kFar, kFar}));
}

}  // namespace
}  // namespace qtet
