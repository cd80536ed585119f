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

TEST(CellAtPoint, theCellThatHoldsItGoesBeforeANearOne) {
  std::vector<LatticePoint> points = kPoints;
  points.push_back({0, 0, -10});
  const std::vector<Tetrahedron> cells = {{0, 2, 1, 4}, {0, 1, 2, 3}};
  const auto found = cellAtPoint(points, cells, {1, 1, 0.5});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cell, 1u);
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
