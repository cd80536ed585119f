// Tests point fields along a split: the residuals of a linear field, both ways, and values at the
// limits.
#include "codec/record/point_values.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "proto/limits.h"
#include "tests/support/star_mesh.h"

namespace qtet {
namespace {

using testing::StarMesh;

constexpr LatticePoint kStarCentre{30000, 30000, 30000};

LatticePoint away(std::int32_t x, std::int32_t y, std::int32_t z) {
  return {kStarCentre[0] + x, kStarCentre[1] + y, kStarCentre[2] + z};
}

std::int32_t linear(const LatticePoint& p) {
  return 3 * (p[0] - kStarCentre[0]) - 2 * (p[1] - kStarCentre[1]) + 5 * (p[2] - kStarCentre[2]) +
         1000;
}

Split splitInto(std::initializer_list<LatticePoint> points) {
  Split split;
  split.k = static_cast<int>(points.size());
  std::ranges::copy(points, split.points.begin());
  return split;
}

struct Field {
  std::vector<std::int32_t> values;
  std::int32_t& operator()(VertexId v, std::uint32_t) { return values[v]; }
};

/// The field on the star, with room for three new vertices.
Field fieldOn(const StarMesh& star) {
  Field field;
  for (const LatticePoint& p : star.mesh.points) field.values.push_back(linear(p));
  field.values.resize(field.values.size() + 3);
  return field;
}

/// The values coded for each prey vertex when the field is linear.
std::vector<std::int32_t> residuals(const StarMesh& star, const Split& split) {
  PointAncestry ancestry(true);
  ancestry.add(0, star.mesh, star.link, split);
  Field field = fieldOn(star);
  Values values;
  ancestry.code<true>(
      ancestry.births().back(), values, 1,
      [&](VertexId v, std::uint32_t c) -> std::int32_t& { return field(v, c); },
      [&](std::size_t i, std::uint32_t) { return linear(split.points[i]); });
  return values.written();
}

void expectNothingTold(const StarMesh& star, const Split& split, std::int32_t rounding) {
  const std::vector<std::int32_t> told = residuals(star, split);
  ASSERT_EQ(told.size(), static_cast<std::size_t>(split.k));
  for (std::size_t i = 0; i < told.size(); ++i)
    EXPECT_LE(std::abs(told[i]), rounding) << "prey " << i << " of " << split.k;
}

TEST(PointAncestry, aLinearFieldIsPredictedUpToRounding) {
  const StarMesh star = testing::starMesh(kStarCentre, {512, 256, 128}, 16);
  // Weights have 12 bits, the place along an edge 8: differences of up to 4,096 are right within 2
  // or 10.
  expectNothingTold(star, splitInto({kStarCentre, away(300, 17, -40)}), 2);
  expectNothingTold(star, splitInto({away(-100, 100, 50), away(100, -100, -50)}), 10);
  expectNothingTold(star, splitInto({away(100, 0, 0), away(-300, 0, 0)}), 10);
  expectNothingTold(star, splitInto({away(211, -3, 99), away(-300, 50, 1), away(10, 20, -90)}), 2);
  expectNothingTold(
      star, splitInto({away(211, -3, 99), away(-300, 50, 1), away(10, 20, -90), away(0, 0, 128)}),
      2);
}

TEST(PointAncestry, onTheBoundaryTheInnerSideTellsTheSlope) {
  const StarMesh star = testing::starMesh(kStarCentre, {512, 256, 128}, 16, true);
  expectNothingTold(star, splitInto({kStarCentre, away(0, 0, 90)}), 2);
  expectNothingTold(star, splitInto({kStarCentre, away(120, 50, 60)}), 2);
  expectNothingTold(star, splitInto({away(120, 50, 60), away(20, -5, 30), away(0, 99, 1)}), 2);
}

TEST(PointAncestry, aStarThatEndsAtOnceTellsNothing) {
  // The prey lies twenty times as far as the star reaches.
  const StarMesh star = testing::starMesh(kStarCentre, {8, 8, 8}, 16);
  const Split split = splitInto({kStarCentre, away(640, 0, 0)});
  const std::vector<std::int32_t> told = residuals(star, split);
  EXPECT_EQ(told[0], 0);
  EXPECT_EQ(told[1], 3 * 640);
}

TEST(PointAncestry, preyInOnePlaceHaveTheFusedVertexsValue) {
  const StarMesh star = testing::starMesh(kStarCentre, {512, 256, 128}, 16);
  EXPECT_EQ(residuals(star, splitInto({kStarCentre, kStarCentre})),
            (std::vector<std::int32_t>{0, 0}));
}

TEST(PointAncestry, aDecoderGetsWhatTheEncoderTold) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    const StarMesh star = testing::starMesh(kStarCentre, {512, 256, 128}, 16, round % 2 == 0);
    const std::uint32_t components = 1 + random() % kMaxFieldComponents;
    Split split;
    split.k = 2 + static_cast<int>(random() % 3);
    for (LatticePoint& p : split.points)
      p = away(static_cast<std::int32_t>(random() % 999) - 500,
               static_cast<std::int32_t>(random() % 999) - 500, 3);
    PointAncestry ancestry(true);
    ancestry.add(0, star.mesh, star.link, split);
    std::vector<std::int32_t> before((star.mesh.points.size() + 3) * components),
        truth(std::size_t{4} * components);
    for (std::int32_t& value : before) value = static_cast<std::int32_t>(random() % 4096);
    for (std::int32_t& value : truth) value = static_cast<std::int32_t>(random() % 4096);
    std::vector<std::int32_t> encoded = before, decoded = before;
    const auto into = [&](std::vector<std::int32_t>& field) {
      return [&field, components](VertexId v, std::uint32_t c) -> std::int32_t& {
        return field[std::size_t{v} * components + c];
      };
    };
    Values told;
    ancestry.code<true>(ancestry.births()[0], told, components, into(encoded),
                        [&](std::size_t i, std::uint32_t c) { return truth[i * components + c]; });
    Values given(told.written());
    ancestry.code<false>(ancestry.births()[0], given, components, into(decoded),
                         [](std::size_t, std::uint32_t) { return 0; });
    ASSERT_TRUE(given.atEnd());
    ASSERT_EQ(decoded, encoded);
    for (std::uint32_t c = 0; c < components; ++c) {
      ASSERT_EQ(decoded[c], truth[c]);  // prey 0 keeps the slot
      for (std::size_t i = 1; i < static_cast<std::size_t>(split.k); ++i)
        ASSERT_EQ(decoded[(star.mesh.points.size() + i - 1) * components + c],
                  truth[i * components + c]);
    }
  }
}

// The steepest field that a log can hold, prey far beyond the star: the prediction must leave a
// difference that a value block can carry.
TEST(PointAncestry, theLargestValuesOverTheLongestStepComeBack) {
  constexpr std::int32_t kLargest = (1 << kMaxFieldBits) - 1;
  const StarMesh star = testing::starMesh(kStarCentre, {128, 128, 128}, 16);
  const Split split = splitInto({away(4000, 0, 0), away(5000, 0, 0)});  // four steps away
  for (const bool rising : {true, false}) {
    Field field;
    for (const LatticePoint& p : star.mesh.points)
      field.values.push_back((p[0] > kStarCentre[0]) == rising ? kLargest : 0);
    field.values.resize(field.values.size() + 3);
    field.values[0] = kLargest / 2;
    PointAncestry ancestry(true);
    ancestry.add(0, star.mesh, star.link, split);
    const auto into = [](Field& f) {
      return [&f](VertexId v, std::uint32_t c) -> std::int32_t& { return f(v, c); };
    };
    const auto truth = [&](std::size_t i, std::uint32_t) { return i == 0 ? 0 : kLargest; };
    Field decoded = field;
    Values told;
    ancestry.code<true>(ancestry.births()[0], told, 1, into(field), truth);
    EXPECT_FALSE(told.bad());
    for (const std::int32_t value : told.written())
      EXPECT_LE(std::abs(std::int64_t{value}), kMaxDracoMagnitude);
    Values given(told.written());
    ancestry.code<false>(ancestry.births()[0], given, 1, into(decoded), truth);
    EXPECT_FALSE(given.bad());
    EXPECT_EQ(decoded(0, 0), 0);
    EXPECT_EQ(decoded(static_cast<VertexId>(star.mesh.points.size()), 0), kLargest);
  }
}

// Hostile values are bounded, not small: sums over a slope must stay within 64 bits (a sanitizer
// looks).
TEST(PointAncestry, valuesAtTheDecodersBoundOverflowNothing) {
  constexpr std::int32_t kBound = 1 << 30;
  const StarMesh star = testing::starMesh(kStarCentre, {128, 128, 128}, 16);
  PointAncestry ancestry(true);
  ancestry.add(0, star.mesh, star.link, splitInto({away(-4000, 0, 0), away(-5000, 0, 0)}));
  Field field;
  for (const LatticePoint& p : star.mesh.points)
    field.values.push_back(p[0] > kStarCentre[0] ? kBound : -kBound);
  field.values.resize(field.values.size() + 3);
  const std::vector<std::int32_t> wild{std::numeric_limits<std::int32_t>::min(),
                                       std::numeric_limits<std::int32_t>::max()};
  Values given(wild);
  ancestry.code<false>(
      ancestry.births()[0], given, 1,
      [&](VertexId v, std::uint32_t c) -> std::int32_t& { return field(v, c); },
      [](std::size_t, std::uint32_t) { return 0; });
  EXPECT_TRUE(given.bad());
  for (const std::int32_t value : field.values) EXPECT_LE(std::abs(value), kBound);
}

}  // namespace
}  // namespace qtet
