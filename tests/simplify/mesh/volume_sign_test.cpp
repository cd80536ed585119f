#include "simplify/mesh/volume_sign.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "codec/mesh/predicates.h"

namespace qtet {
namespace {

TEST(VolumeSign, seesOneBitOfDifference) {
  const Position a{0.1, 0.2, 0.3}, b{0.7, 0.1, 0.5}, c{0.3, 0.9, 0.4};
  // The fourth vertex is the third, then moved by the smallest amount there is.
  EXPECT_EQ(volumeSign(a, b, c, c), 0);
  EXPECT_EQ(volumeSign(a, b, c, {c[0], c[1], std::nextafter(c[2], 2.0)}),
            -volumeSign(a, b, c, {c[0], c[1], std::nextafter(c[2], -2.0)}));
  EXPECT_NE(volumeSign(a, b, c, {c[0], c[1], std::nextafter(c[2], 2.0)}), 0);
}

TEST(VolumeSign, isExactWhereDoublesRoundToZero) {
  // (1 + e)^2 - 1 - 2 e = e^2 with e = 2^-50: the rounded determinant loses it.
  const double e = std::ldexp(1.0, -50);
  EXPECT_EQ(volumeSign({0, 0, 0}, {1 + e, 1, 0}, {1 + 2 * e, 1 + e, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(volumeSign({0, 0, 0}, {1 + 2 * e, 1 + e, 0}, {1 + e, 1, 0}, {0, 0, 1}), -1);
}

TEST(VolumeSign, worksAtBothEndsOfTheDoubles) {
  for (const double scale : {1e-320, 1e-200, 1.0, 1e150, 1e307}) {
    EXPECT_EQ(volumeSign({0, 0, 0}, {scale, 0, 0}, {0, scale, 0}, {0, 0, scale}), 1) << scale;
    EXPECT_EQ(volumeSign({0, 0, 0}, {0, scale, 0}, {scale, 0, 0}, {0, 0, scale}), -1) << scale;
    EXPECT_EQ(volumeSign({0, 0, 0}, {scale, 0, 0}, {0, scale, 0}, {scale, scale, 0}), 0) << scale;
  }
}

TEST(VolumeSign, agreesWithTheLatticePredicate) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::int32_t> coordinate(0, 6);
  int flat = 0;
  for (int round = 0; round < 5000; ++round) {
    std::array<LatticePoint, 4> p;
    std::array<Position, 4> q;
    for (std::size_t i = 0; i < 4; ++i) {
      p[i] = {coordinate(random), coordinate(random), coordinate(random)};
      q[i] = {p[i][0] * 0.125, p[i][1] * 0.125, p[i][2] * 0.125};
    }
    const int sign = orientation(p[0], p[1], p[2], p[3]);
    flat += sign == 0;
    ASSERT_EQ(volumeSign(q[0], q[1], q[2], q[3]), sign);
  }
  EXPECT_GT(flat, 100);
}

}  // namespace
}  // namespace qtet
