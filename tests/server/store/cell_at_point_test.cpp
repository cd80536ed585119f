#include "server/store/cell_at_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

const std::vector<LatticePoint> kPoints = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
const std::vector<Tetrahedron> kCell = {{0, 1, 2, 3}};

TEST(CellAtPoint, weightsGiveThePointBack) {
  const LatticeMesh mesh = testing::gridMesh(3, 5);
  for (CellId t = 0; t < mesh.tetrahedra.size(); ++t) {
    std::array<double, 3> middle{};
    for (const VertexId v : mesh.tetrahedra[t])
      for (std::size_t a = 0; a < 3; ++a) middle[a] += mesh.points[v][a] / 4.0;
    const auto found = cellAtPoint(mesh.points, mesh.tetrahedra, middle);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->cell, t);
    for (const double weight : found->weights) EXPECT_NEAR(weight, 0.25, 1e-12);
  }
}

TEST(CellAtPoint, aCornerCountsAloneAtItself) {
  const auto found = cellAtPoint(kPoints, kCell, {0, 10, 0});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->weights, (std::array<double, 4>{0, 0, 1, 0}));
}

TEST(CellAtPoint, aPointOutsideByAStepIsTheCellsAndNoFurtherOne) {
  for (const double x : {10 + kNearSteps - 0.01, 10 + kNearSteps}) {
    const auto found = cellAtPoint(kPoints, kCell, {x, 0, 0});
    ASSERT_TRUE(found) << x;
    EXPECT_EQ(found->weights, (std::array<double, 4>{0, 1, 0, 0}));
  }
  EXPECT_FALSE(cellAtPoint(kPoints, kCell, {10 + kNearSteps + 0.01, 0, 0}));
  EXPECT_FALSE(cellAtPoint(kPoints, kCell, {0, -kNearSteps - 0.01, 0}));
  EXPECT_FALSE(cellAtPoint(kPoints, kCell, {6, 6, 0})) << "within the box, 1.4 steps outside";
}

// A boundary layer's cells are flat. The corner opposite to the wall is far along it.
TEST(CellAtPoint, aPointOverAFlatCellIsNearItsFaceNotItsCorner) {
  const std::vector<LatticePoint> points = {{0, 0, 0}, {300, 0, 0}, {0, 300, 0}, {290, 5, 3}};
  for (const double outside : {0.5, 0.99}) {
    const auto found = cellAtPoint(points, kCell, {20, 30, -outside});
    ASSERT_TRUE(found) << outside;
    EXPECT_EQ(found->weights[3], 0);
    EXPECT_NEAR(found->weights[1], 20 / 300.0, 1e-12);
    EXPECT_NEAR(found->weights[2], 30 / 300.0, 1e-12);
  }
  EXPECT_FALSE(cellAtPoint(points, kCell, {20, 30, -1.01}));
  const auto beside = cellAtPoint(points, kCell, {150, -0.5, -0.5});
  ASSERT_TRUE(beside) << "nearest to an edge";
  EXPECT_NEAR(beside->weights[1], 0.5, 1e-12);
}

// The determinants of coplanar corners are noise where the point is no integer.
TEST(CellAtPoint, aCellThatIsFlatButForRoundingHoldsNothingFar) {
  const std::vector<LatticePoint> points = {
      {3, 7, 11}, {103, 57, 36}, {53, 132, 68}, {153, 182, 93}};
  for (int i = 0; i < 200; ++i) {
    const double t = 0.37 * i;
    EXPECT_FALSE(cellAtPoint(points, kCell, {80.1 + t / 10, 90.7 - t / 7, 200.3 + t})) << i;
  }
}

TEST(CellAtPoint, theCellThatHoldsItGoesBeforeANearOne) {
  std::vector<LatticePoint> points = kPoints;
  points.push_back({0, 0, -10});
  const std::vector<Tetrahedron> cells = {{0, 2, 1, 4}, {0, 1, 2, 3}};
  const auto found = cellAtPoint(points, cells, {1, 1, 0.5});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cell, 1u);
}

TEST(CellAtPoint, aLevelWithAKnownErrorHoldsThePointsThatItLost) {
  EXPECT_EQ(nearStepsOf(kPoints, std::nullopt), kNearSteps);
  LevelError error;
  EXPECT_EQ(nearStepsOf(kPoints, error), kNearSteps);
  error.toLevel.max = 0.1;
  EXPECT_EQ(nearStepsOf({}, error), kNearSteps);
  // A sphere of radius 100 whose level is the octahedron inside: its faces are 42.3 steps away.
  const std::vector<LatticePoint> level{{0, 100, 100},   {200, 100, 100}, {100, 0, 100},
                                        {100, 200, 100}, {100, 100, 0},   {100, 100, 200}};
  error.toLevel.max = 42.3 / (200 * std::sqrt(3.0));
  EXPECT_GE(nearStepsOf(level, error), 42.3);
  EXPECT_LE(nearStepsOf(level, error), 2 * 42.3);
  const double near = nearStepsOf(kPoints, error);
  EXPECT_TRUE(cellAtPoint(kPoints, kCell, {10 + near, 0, 0}, near));
  EXPECT_FALSE(cellAtPoint(kPoints, kCell, {10.01 + near, 0, 0}, near));
}

TEST(CellAtPoint, nothingIsNearAnEmptyMeshOrACellWithoutVolume) {
  EXPECT_FALSE(cellAtPoint({}, {}, {0, 0, 0}));
  const std::vector<LatticePoint> flat = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {5, 5, 0}};
  EXPECT_FALSE(cellAtPoint(flat, kCell, {2, 2, 0}));
  const double huge = 1e308;
  EXPECT_FALSE(cellAtPoint(kPoints, kCell, {huge, -huge, huge}));
}

}  // namespace
}  // namespace qtet
