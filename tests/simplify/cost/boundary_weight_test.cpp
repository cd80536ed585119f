#include "simplify/cost/boundary_weight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simplify/cost/fusion_cost.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::gridMesh;

/// The cube of a gridMesh with one field, `valueOf` each point, whose range is its side.
template <class ValueOf>
LatticeMesh cubeWith(const ValueOf& valueOf) {
  LatticeMesh mesh = gridMesh(4, 1);
  std::int32_t side = 0;
  for (const LatticePoint& p : mesh.points) side = std::max(side, p[0]);
  mesh.fields = {{"s", 1, "float32", "point", 16, 1, {0}, {0, static_cast<double>(side)}}};
  mesh.values = {{}};
  for (const LatticePoint& p : mesh.points) mesh.values[0].push_back(valueOf(p, side));
  return mesh;
}

double weightOf(const LatticeMesh& mesh) {
  return balancedBoundaryWeight(mesh, costPartsOf(mesh, {}));
}

// A field over its range that is x over the side L: squared gradient 1 / L^2, diagonal sqrt 3 L,
// volume over area L / 6.
TEST(BoundaryWeight, isSixTimesDiagonalVolumeAndSquaredGradientOverArea) {
  const LatticeMesh mesh = cubeWith([](const LatticePoint& p, std::int32_t) { return p[0]; });
  EXPECT_NEAR(weightOf(mesh), std::sqrt(3.0), 1e-9);
}

TEST(BoundaryWeight, countsTheFieldsChangeAtTheBoundaryAlone) {
  const LatticeMesh flat = cubeWith([](const LatticePoint& p, std::int32_t side) {
    const auto inner = [&](std::int32_t x) { return x > side * 3 / 8 && x < side * 5 / 8; };
    return inner(p[0]) && inner(p[1]) && inner(p[2]) ? side : 0;
  });
  EXPECT_EQ(weightOf(flat), 0.5) << "it is steep round the cube's middle, where the boundary does "
                                    "not see it; the least weight holds";
  const LatticeMesh steep = cubeWith(
      [](const LatticePoint& p, std::int32_t side) { return (p[0] + p[1] + p[2]) * 4 % side; });
  EXPECT_GT(weightOf(steep), 10);
  EXPECT_LE(weightOf(steep), 200);
}

TEST(BoundaryWeight, countsEachFieldByItsWeight) {
  LatticeMesh mesh = cubeWith([](const LatticePoint& p, std::int32_t) { return p[0]; });
  mesh.fields.push_back(mesh.fields[0]);
  mesh.fields[1].range[1] /= 2;  // twice as steep over its range
  mesh.values.push_back(mesh.values[0]);
  EXPECT_NEAR(balancedBoundaryWeight(mesh, costPartsOf(mesh, std::vector<double>{1, 0})),
              std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(balancedBoundaryWeight(mesh, costPartsOf(mesh, std::vector<double>{0, 1})),
              4 * std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(balancedBoundaryWeight(mesh, costPartsOf(mesh, std::vector<double>{3, 1})),
              1.75 * std::sqrt(3.0), 1e-9);
}

TEST(BoundaryWeight, isWhatTheCostTakesWhenNobodySays) {
  const LatticeMesh mesh = gridMesh(4, 2);
  const FusionMesh live(mesh);
  CostOptions explicitly, other;
  explicitly.boundaryWeight = weightOf(mesh);
  other.boundaryWeight = 2 * *explicitly.boundaryWeight;
  const Triangle& face = mesh.boundary[0];
  const Prey prey{2, {face[0], face[1], 0, 0}};
  const auto costOf = [&](const CostOptions& options) {
    return FusionCost(live, mesh, options).of(prey).quadric.at({5, 7, 3});
  };
  EXPECT_EQ(costOf({}), costOf(explicitly));
  EXPECT_NE(costOf({}), costOf(other));
}

}  // namespace
}  // namespace qtet
