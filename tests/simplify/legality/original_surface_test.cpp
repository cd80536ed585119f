// How far tetrahedra lie outside a solid, beside brute force.
#include "simplify/legality/original_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/meshes.h"
#include "tests/support/random_solid.h"

namespace qtet {
namespace {

using Corners = OriginalSurface::Corners;

double lengthOf(const LatticeMesh& mesh) {
  std::int32_t most = 0;
  for (const LatticePoint& p : mesh.points) most = std::max({most, p[0], p[1], p[2]});
  return most;
}

/// The largest distance outside of the solid among places of the tetrahedron.
double sampledOutside(const LatticeMesh& mesh, const Corners& t) {
  constexpr int kParts = 6;
  double most = 0;
  for (int i = 0; i <= kParts; ++i)
    for (int j = 0; i + j <= kParts; ++j)
      for (int k = 0; i + j + k <= kParts; ++k) {
        const Vector3 p =
            1.0 / kParts *
            (static_cast<double>(i) * t[0] + static_cast<double>(j) * t[1] +
             static_cast<double>(k) * t[2] + static_cast<double>(kParts - i - j - k) * t[3]);
        most = std::max(
            most, testing::distanceOutside(mesh, {static_cast<std::int32_t>(std::lround(p[0])),
                                                  static_cast<std::int32_t>(std::lround(p[1])),
                                                  static_cast<std::int32_t>(std::lround(p[2]))}));
      }
  return most;
}

class Near : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(Near, noPlaceOfATetrahedronThatHoldsIsFurtherOutside) {
  const auto solid = testing::randomSolid(GetParam());
  SCOPED_TRACE(solid.description);
  const FusionMesh mesh(solid.mesh);
  const OriginalSurface surface(mesh);
  DistanceCells known;
  std::mt19937 random(GetParam());
  const double length = lengthOf(solid.mesh);
  const auto upTo = [&](double most) { return most * static_cast<double>(random() % 1024) / 1024; };
  int held = 0, refused = 0, near = 0, nearHeld = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const LatticePoint& from = solid.mesh.points[random() % solid.mesh.points.size()];
    const double size = trial % 3 == 0 ? length / 2 : length / 12, tolerance = upTo(length / 8);
    Corners t;
    for (Vector3& corner : t)
      for (std::size_t k = 0; k < 3; ++k)
        corner[k] = std::floor(std::clamp(from[k] + upTo(size) - size / 2, 0.0, length));
    const double outside = sampledOutside(solid.mesh, t);
    const bool holds = surface.holds(t, {surface, tolerance}, known);
    // places are rounded to the lattice
    if (holds) {
      ASSERT_LE(outside, tolerance + 0.87) << "trial " << trial;
    }
    held += holds, refused += !holds;
    const bool isNear = outside < tolerance / 2 && tolerance > length / 100;
    near += isNear, nearHeld += isNear && holds;
  }
  EXPECT_GT(held, 5);
  EXPECT_GT(refused, 5);
  EXPECT_GT(4 * nearHeld, 3 * near) << "what is clearly near should hold, mostly";
}

INSTANTIATE_TEST_SUITE_P(Seeds, Near, ::testing::Range(0u, 12u));

TEST(OriginalSurface, whatHoldsDoesNotDependOnWhatWasAskedBefore) {
  const auto solid = testing::randomSolid(5);
  const FusionMesh mesh(solid.mesh);
  const OriginalSurface surface(mesh);
  DistanceCells known;
  std::mt19937 random(1);
  const double length = lengthOf(solid.mesh);
  const OriginalSurface::Tolerances tolerances(surface, length / 10);
  for (int trial = 0; trial < 500; ++trial) {
    Corners t;
    for (Vector3& corner : t)
      for (double& x : corner) x = length * static_cast<double>(random() % 1024) / 1024;
    DistanceCells fresh;
    ASSERT_EQ(surface.holds(t, tolerances, known), surface.holds(t, tolerances, fresh));
  }
}

// Beside an edge and a corner the nearest triangle's plane alone gives the wrong side.
TEST(OriginalSurface, insideIsToldBesideSharpEdgesToo) {
  const LatticeMesh mesh = testing::gridMesh(
      6, 1, [](int i, int j, int k) { return i == 2 || (j == 3 && k > 1) || (i > 2 && k == 4); });
  const FusionMesh fusion(mesh);
  const OriginalSurface surface(fusion);
  std::mt19937 random(2);
  const auto most = static_cast<std::uint32_t>(lengthOf(mesh)) + 1;
  int inside = 0, told = 0, outside = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const LatticePoint p{static_cast<std::int32_t>(random() % most),
                         static_cast<std::int32_t>(random() % most),
                         static_cast<std::int32_t>(random() % most)};
    NearestTriangle nearest;
    surface.tree().nearest(toVector(p), nearest);
    if (nearest.point.squared == 0) continue;
    const bool isInside = testing::distanceOutside(mesh, p) == 0;
    const bool isTold = surface.isInside(toVector(p), nearest);
    ASSERT_TRUE(isInside || !isTold) << p[0] << " " << p[1] << " " << p[2];
    inside += isInside, told += isTold, outside += !isInside;
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 100);
  EXPECT_GT(10 * told, 9 * inside) << "where the surface is a manifold it is known";
}

}  // namespace
}  // namespace qtet
