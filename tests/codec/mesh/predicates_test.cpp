#include "codec/mesh/predicates.h"

#include <gtest/gtest.h>

#include <random>

namespace qtet {
namespace {

constexpr std::int32_t kLargest = (1 << kMaxPositionBits) - 1;

TEST(Predicates, aCellInTheOrderOfVtkIsPositive) {
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orientation({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}), -1);
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 7, 0}), 0);
}

TEST(Predicates, theLargestDeterminantIsExact) {
  // A cube's inscribed tetrahedron: 2 L^3, the largest volume inside the lattice.
  const std::int32_t L = kLargest;
  const Int128 volume = volume6({0, 0, 0}, {L, L, 0}, {0, L, L}, {L, 0, L});
  EXPECT_TRUE(volume == Int128{2} * L * L * L);
}

TEST(Predicates, oneStepAtTheFarEndOfTheLatticeDecides) {
  const std::int32_t L = kLargest;
  EXPECT_EQ(orientation({0, 0, 0}, {L, 0, L}, {0, L, L}, {L, L - 1, L}),
            orientation({0, 0, 0}, {2, 0, 2}, {0, 2, 2}, {2, 1, 2}));
  EXPECT_EQ(orientation({0, 0, 0}, {L, 0, 0}, {0, L, 0}, {L, L, 1}), 1);
  EXPECT_EQ(orientation({0, 0, 1}, {L, 0, 1}, {0, L, 1}, {L, L, 0}), -1);
}

TEST(Predicates, bothPathsAgreeAroundTheLengthThatDividesThem) {
  std::mt19937 random(7);
  for (int round = 0; round < 20000; ++round) {
    const std::int32_t limit = 1 << (round % 2 ? kShortBits : kShortBits + 1);
    std::uniform_int_distribution<std::int32_t> coordinate(0, limit);
    std::array<LatticePoint, 4> p;
    for (LatticePoint& point : p)
      point = {coordinate(random), coordinate(random), coordinate(random)};
    const detail::Difference u = detail::difference(p[0], p[1]), v = detail::difference(p[0], p[2]),
                             w = detail::difference(p[0], p[3]);
    const Int128 wide = detail::determinant<Int128>(u, v, w);
    ASSERT_TRUE(volume6(p[0], p[1], p[2], p[3]) == wide);
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), (wide > 0) - (wide < 0));
  }
}

TEST(Predicates, anExchangeOfTwoVerticesTurnsTheSign) {
  std::mt19937 random(11);
  std::uniform_int_distribution<std::int32_t> coordinate(0, kLargest);
  for (int round = 0; round < 1000; ++round) {
    std::array<LatticePoint, 4> p;
    for (LatticePoint& point : p)
      point = {coordinate(random), coordinate(random), coordinate(random)};
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), -orientation(p[0], p[1], p[3], p[2]));
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), orientation(p[1], p[2], p[0], p[3]));
  }
}

}  // namespace
}  // namespace qtet
