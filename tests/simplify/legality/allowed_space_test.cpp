// Where the solid may grow, beside brute force and beside the search without cubes.
#include "simplify/legality/allowed_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "simplify/legality/touched_cells.h"
#include "tests/support/meshes.h"
#include "tests/support/random_solid.h"

namespace qtet {
namespace {

using Corners = AllowedSpace::Corners;

/// A place of the tetrahedron, its weights out of the random numbers.
template <class Random>
Vector3 placeIn(const Corners& t, Random& random) {
  Vector3 out{};
  double sum = 0;
  for (const Vector3& corner : t) {
    const double weight = static_cast<double>(random() % 1024) + (random() % 3 == 0 ? 0 : 1e-3);
    out = out + weight * corner, sum += weight;
  }
  return 1 / std::max(sum, 1e-3) * out;
}

/// Some triangle is no further away than its tolerance.
bool isNearOne(const AllowedSpace& allowed, const Vector3& p) {
  const std::vector<float>& own = allowed.tolerances().own;
  for (std::uint32_t t = 0; t < own.size(); ++t)
    if (nearestOnTriangle(p, allowed.surface().tree().corners(t)).squared <= own[t] * own[t] + 1e-6)
      return true;
  return false;
}

TEST(TouchedCells, everyPlaceOfATetrahedronIsInACubeThatIsVisited) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 160; ++trial) {
    Corners t;
    const std::uint32_t size = trial % 3 == 0 ? 3 : 40;
    for (Vector3& corner : t)
      for (double& x : corner) x = static_cast<double>(random() % (16 * size)) / 16;
    if (trial % 4 == 1) t[3] = 0.5 * (t[0] + t[1]);      // flat
    if (trial % 4 == 2) t[3] = t[2] = t[1] = t[0];       // a point
    if (trial % 4 == 3) t[3] = t[2] + Vector3{0, 0, 1};  // thin
    std::vector<std::array<std::int32_t, 3>> visited;
    eachTouchedCell(t, [&](const auto& cell) {
      visited.push_back(cell);
      return true;
    });
    for (int place = 0; place < 50; ++place) {
      const Vector3 p = placeIn(t, random);
      const auto holds = [&](const std::array<std::int32_t, 3>& cell) {
        bool isIn = true;
        for (std::size_t k = 0; k < 3; ++k)
          isIn &= p[k] >= cell[k] - 1e-9 && p[k] <= cell[k] + 1 + 1e-9;
        return isIn;
      };
      ASSERT_TRUE(std::ranges::any_of(visited, holds)) << "trial " << trial;
    }
  }
}

TEST(TouchedCells, aThinTetrahedronVisitsFewCubes) {
  const Corners t{Vector3{1, 1, 1}, Vector3{41, 1, 21}, Vector3{1, 41, 21}, Vector3{14, 14, 14.5}};
  int count = 0;
  eachTouchedCell(t, [&](const auto&) { return ++count > 0; });
  EXPECT_LT(count, 4 * 800) << "its largest face passes 800 rows";
}

class Allowed : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(Allowed, whatHoldsIsNearATriangleThatAllowsIt) {
  const auto solid = testing::randomSolid(GetParam());
  SCOPED_TRACE(solid.description);
  std::int32_t length = 0;
  for (const LatticePoint& p : solid.mesh.points) length = std::max({length, p[0], p[1], p[2]});
  std::mt19937 random(GetParam());
  const auto upTo = [&](double most) { return most * static_cast<double>(random() % 1024) / 1024; };
  int held = 0, found = 0, refused = 0;
  for (const double share : {10.0, 30.0, 500.0}) {  // the last one is too small for cubes
    const AllowedSpace allowed(FusionMesh(solid.mesh), length / share);
    DistanceCells known, distances;
    for (int trial = 0; trial < 100; ++trial) {
      const LatticePoint& from = solid.mesh.points[random() % solid.mesh.points.size()];
      const double size = trial % 8 == 0 ? length / 2.0 : length / 16.0;
      Corners t;
      for (Vector3& corner : t)
        for (std::size_t k = 0; k < 3; ++k)
          corner[k] = std::floor(std::clamp(from[k] + upTo(size) - size / 2, 0.0, length * 1.0));
      found += allowed.surface().holds(t, allowed.tolerances(), distances);
      const bool holds = allowed.holds(t, known);
      held += holds, refused += !holds;
      for (int place = 0; holds && place < 6; ++place) {
        const Vector3 p = placeIn(t, random);
        LatticePoint there{};
        for (std::size_t k = 0; k < 3; ++k) there[k] = static_cast<std::int32_t>(std::lround(p[k]));
        ASSERT_TRUE(testing::distanceOutside(solid.mesh, there) <= 0.87 || isNearOne(allowed, p));
      }
    }
  }
  EXPECT_GT(refused, 15);
  EXPECT_GT(3 * held, found) << "the search alone finds more, but not three times as many";
}

INSTANTIATE_TEST_SUITE_P(Seeds, Allowed, ::testing::Range(0u, 12u));

}  // namespace
}  // namespace qtet
