#include "simplify/cost/boundary_weight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "simplify/cost/expected_error.h"
#include "simplify/cost/fusion_cost.h"
#include "simplify/mesh/split_mix64.h"
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

double weightBy(const LatticeMesh& mesh, const std::vector<double>& fieldWeights) {
  const std::vector<CostPart> parts = costPartsOf(mesh, fieldWeights);
  return balancedBoundaryWeight(mesh, parts, expectedFieldErrors(mesh, parts));
}
double weightOf(const LatticeMesh& mesh) { return weightBy(mesh, {}); }

double expectedFieldError(const LatticeMesh& mesh) {
  return expectedFieldErrors(mesh, costPartsOf(mesh, {})).at(0);
}

// The field over its range is x over the side L. So its squared gradient is 1 / L^2, the diagonal
// sqrt 3 L, volume over area L / 6. A cube has creases alone, so the balance has no say.
TEST(BoundaryWeight, isAtMostOneAndAHalfTimesDiagonalVolumeAndSquaredGradientOverArea) {
  const LatticeMesh mesh = cubeWith([](const LatticePoint& p, std::int32_t) { return p[0]; });
  EXPECT_NEAR(weightOf(mesh), std::sqrt(3.0) / 4, 1e-9);
}

TEST(BoundaryWeight, countsTheFieldsChangeAtTheBoundaryAlone) {
  const LatticeMesh flat = cubeWith([](const LatticePoint& p, std::int32_t side) {
    const auto inner = [&](std::int32_t x) { return x > side * 3 / 8 && x < side * 5 / 8; };
    return inner(p[0]) && inner(p[1]) && inner(p[2]) ? side : 0;
  });
  EXPECT_EQ(weightOf(flat), 0.05) << "it is steep round the cube's middle, where the boundary does "
                                     "not see it; the least weight holds";
  const LatticeMesh steep = cubeWith(
      [](const LatticePoint& p, std::int32_t side) { return (p[0] + p[1] + p[2]) * 4 % side; });
  EXPECT_GT(weightOf(steep), 2.5);
  EXPECT_LE(weightOf(steep), 200);
}

/// A grid whose points are moved by up to `rough` / 2 of an edge, with a field of curvature `bend`.
LatticeMesh roughCube(double rough, double bend) {
  LatticeMesh mesh = gridMesh(8, 1);
  std::int32_t side = 0;
  for (const LatticePoint& p : mesh.points) side = std::max(side, p[0]);
  SplitMix64 random(7);
  mesh.fields = {{"s", 1, "float32", "point", 16, 1, {0}, {0, 65535}}};
  mesh.values = {{}};
  for (LatticePoint& p : mesh.points) {
    for (std::int32_t& c : p)
      c += static_cast<std::int32_t>(rough * side / 8 * (random.unit() - 0.5)) + side / 8;
    const double x = static_cast<double>(p[0]) / (1.25 * side);
    mesh.values[0].push_back(
        static_cast<std::int32_t>(std::lround(60000 * ((1 - bend) * x + bend * x * x))));
  }
  return mesh;
}

TEST(BoundaryWeight, isLessTheRougherTheBoundaryAndTheSmootherTheField) {
  const double both = weightOf(roughCube(0.3, 2.5));
  EXPECT_LT(weightOf(roughCube(0.4, 2.5)), 0.8 * both);
  EXPECT_LT(weightOf(roughCube(0.3, 1.25)), 0.5 * both);
  EXPECT_GT(both, 0.05);
  EXPECT_LT(both, 1.5) << "the worth";
}

TEST(ExpectedError, vanishesForLinearFieldsButForTheirRounding) {
  EXPECT_LT(expectedFieldError(roughCube(0.2, 0)), 1e-12) << "rounded to 16 bits";
  EXPECT_GT(expectedFieldError(roughCube(0.2, 0.5)), 1e-6);
  const LatticeMesh straight = cubeWith([](const LatticePoint& p, std::int32_t) { return p[0]; });
  EXPECT_LT(expectedFieldError(straight), 1e-18);
  EXPECT_EQ(expectedBoundaryError(straight), 0) << "its edges are creases, its sides flat";
}

TEST(ExpectedError, doesNotDependOnNumbering) {
  const LatticeMesh mesh = roughCube(0.3, 0.5);
  LatticeMesh turned = mesh;
  const auto last = static_cast<VertexId>(mesh.points.size() - 1);
  std::ranges::reverse(turned.points);
  std::ranges::reverse(turned.values[0]);
  for (Tetrahedron& t : turned.tetrahedra)
    for (VertexId& v : t) v = last - v;
  for (Triangle& t : turned.boundary)
    for (VertexId& v : t) v = last - v;
  std::ranges::reverse(turned.tetrahedra);
  const double field = expectedFieldError(mesh), boundary = expectedBoundaryError(mesh);
  EXPECT_NEAR(expectedFieldError(turned), field, 1e-9 * field);
  EXPECT_NEAR(expectedBoundaryError(turned), boundary, 1e-9 * boundary);
}

TEST(BoundaryWeight, countsEachFieldByItsWeight) {
  LatticeMesh mesh = cubeWith([](const LatticePoint& p, std::int32_t) { return p[0]; });
  mesh.fields.push_back(mesh.fields[0]);
  mesh.fields[1].range[1] /= 2;  // twice as steep over its range
  mesh.values.push_back(mesh.values[0]);
  EXPECT_NEAR(weightBy(mesh, {1, 0}), std::sqrt(3.0) / 4, 1e-9);
  EXPECT_NEAR(weightBy(mesh, {0, 1}), std::sqrt(3.0), 1e-9);
  EXPECT_NEAR(weightBy(mesh, {3, 1}), 1.75 / 4 * std::sqrt(3.0), 1e-9);
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
