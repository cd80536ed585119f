// How far a solid may grow at each triangle, where another sheet is near and where none is.
#include "simplify/legality/local_tolerances.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace qtet {
namespace {

/// The tolerances of triangles of three places each.
std::vector<float> tolerancesOf(const std::vector<std::array<LatticePoint, 3>>& triangles,
                                double most) {
  std::vector<LatticePoint> points;
  std::vector<TriangleTree::Cell> cells;
  std::vector<std::uint32_t> ids;
  for (const auto& t : triangles) {
    const auto first = static_cast<VertexId>(points.size());
    points.insert(points.end(), t.begin(), t.end());
    ids.push_back(static_cast<std::uint32_t>(cells.size()));
    cells.push_back({first, first + 1, first + 2, kGhost});
  }
  return localTolerances(TriangleTree(points, cells, ids), most);
}

std::array<LatticePoint, 3> level(std::int32_t corner, std::int32_t size, std::int32_t height) {
  return {LatticePoint{corner, corner, height}, LatticePoint{corner + size, corner, height},
          LatticePoint{corner, corner + size, height}};
}

TEST(LocalTolerances, areAQuarterOfTheWayOutwardsToTheNextSheet) {
  const auto found = tolerancesOf({level(0, 90, 100), level(0, 90, 140), level(0, 90, 400)}, 50);
  EXPECT_FLOAT_EQ(found[0], 10);
  EXPECT_FLOAT_EQ(found[1], 10) << "the other one is above";
  EXPECT_LE(found[0], 10.0f);
  EXPECT_FLOAT_EQ(found[2], 50) << "260 steps are more than it could use up";
}

TEST(LocalTolerances, noWallLimitsThemInwards) {
  auto under = level(0, 90, 100);
  std::swap(under[1], under[2]);  // it looks down
  const auto found = tolerancesOf({under, level(0, 90, 140)}, 50);
  EXPECT_FLOAT_EQ(found[0], 50);
  EXPECT_FLOAT_EQ(found[1], 50);
}

TEST(LocalTolerances, sheetsThatTouchHaveNone) {
  auto above = level(0, 90, 100);
  std::swap(above[1], above[2]);
  for (const float tolerance : tolerancesOf({level(0, 90, 100), above}, 50))
    EXPECT_FLOAT_EQ(tolerance, 0);
}

TEST(LocalTolerances, areAtMostTheGivenOne) {
  for (const std::int32_t gap : {199, 200, 201}) {
    const auto found = tolerancesOf({level(0, 90, 100), level(0, 90, 100 + gap)}, 50);
    EXPECT_FLOAT_EQ(found[0], std::min(50.0f, 0.25f * static_cast<float>(gap))) << gap;
    EXPECT_LT(found[0], 50.0f) << "rounded down";
  }
}

TEST(LocalTolerances, aLargeTriangleKnowsOfASmallOneInFrontOfIt) {
  auto small = level(700, 4, 140);
  std::swap(small[1], small[2]);  // it looks down
  const auto found = tolerancesOf({level(0, 3000, 100), small}, 50);
  EXPECT_FLOAT_EQ(found[0], 10);
  EXPECT_FLOAT_EQ(found[1], 10);
}

/// A small sheet in front of the first corner of level(0, 49 ... 90, 100). Its middle lies beside
/// the larger triangle, so it does not see that one.
constexpr std::array<LatticePoint, 3> kSheetAtTheCorner{
    LatticePoint{-10, -36, 140}, LatticePoint{30, -36, 140}, LatticePoint{4, 10, 140}};

TEST(LocalTolerances, aLargeTriangleLooksFromItsCornersToo) {
  auto large = level(0, 90, 100);
  for (std::size_t first = 0; first < 3; ++first) {
    const auto found = tolerancesOf({large, kSheetAtTheCorner}, 50);
    EXPECT_FLOAT_EQ(found[0], 10) << first;
    EXPECT_FLOAT_EQ(found[1], 10) << first;
    std::ranges::rotate(large, large.begin() + 1);
  }
}

TEST(LocalTolerances, aTriangleIsLargeIfItIsLongerThanTheGivenTolerance) {
  for (const std::int32_t size : {49, 50, 51}) {
    const auto found = tolerancesOf({level(0, size, 100), kSheetAtTheCorner}, 50);
    EXPECT_FLOAT_EQ(found[0], size > 50 ? 10 : 50) << size;
  }
}

TEST(LocalTolerances, aWallThatStandsBesideATriangleIsNoSheet) {
  const std::array<LatticePoint, 3> wall{LatticePoint{100, 0, 0}, LatticePoint{100, 900, 0},
                                         LatticePoint{100, 0, 900}};
  const auto found = tolerancesOf({level(0, 90, 100), wall}, 50);
  EXPECT_FLOAT_EQ(found[0], 50);
}

TEST(LocalTolerances, aDegenerateTriangleHasNone) {
  const LatticePoint p{7, 7, 7};
  EXPECT_EQ(tolerancesOf({level(0, 90, 100), {p, p, p}}, 50)[1], 0);
}

}  // namespace
}  // namespace qtet
