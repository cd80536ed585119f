// Shapes in a star beside their definition, cell by cell.
#include "simplify/legality/star_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/meshes.h"

namespace qtet {
namespace {

/// 6 sqrt(2) V / l^3, l the root mean square edge; negative where the cell is inside out.
double shapeOf(const std::array<Vector3, 4>& corners) {
  const auto& [a, b, c, d] = corners;
  double squares = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      squares += dot(corners[i] - corners[j], corners[i] - corners[j]);
  return std::sqrt(2.0) * dot(cross(b - a, c - a), d - a) / std::pow(squares / 6, 1.5);
}

/// The worst shape round the prey: as it is, and with the prey at p of the cells that stay.
struct Worst {
  double old = 1, now = 1;
};
Worst worstRound(const LatticeMesh& mesh, const Prey& prey, const LatticePoint& p) {
  Worst out;
  for (const Tetrahedron& cell : mesh.tetrahedra) {
    std::array<Vector3, 4> before{}, after{};
    std::size_t held = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool isPrey = std::ranges::find(prey.vertices(), cell[i]) != prey.vertices().end();
      held += isPrey;
      before[i] = toVector(mesh.points[cell[i]]);
      after[i] = isPrey ? toVector(p) : before[i];
    }
    if (held > 0) out.old = std::min(out.old, shapeOf(before));
    if (held == 1) out.now = std::min(out.now, shapeOf(after));
  }
  return out;
}

TEST(StarShapes, areWhatTheDefinitionSaysAndFallToAFifthAtMost) {
  constexpr double kFloor = 0.05;
  const LatticeMesh lattice = testing::gridMesh(4, 1);
  const FusionMesh mesh(lattice);
  LocalStar star(mesh);
  StarShapes shapes(mesh, star, kFloor);
  std::mt19937 random(9);
  std::size_t legal = 0, flipped = 0, tooThin = 0;
  for (VertexId v = 0; v < lattice.points.size(); ++v) {
    if (mesh.onBoundary(v)) continue;
    const auto& cell = mesh.cell(mesh.star(v)[random() % mesh.star(v).size()]);
    const Prey prey{2, {v, cell[0] == v ? cell[1] : cell[0], 0, 0}};
    ASSERT_TRUE(star.gather(prey));
    shapes.measure();
    for (int trial = 0; trial < 200; ++trial) {
      LatticePoint p = lattice.points[v];
      for (std::int32_t& x : p) x += static_cast<std::int32_t>(random() % 61) - 30;
      const Worst plain = worstRound(lattice, prey, p);
      ASSERT_NEAR(shapes.old(), plain.old, 1e-12);
      const double floor = std::min(kFloor, 0.2 * plain.old), shape = shapes.at(p, 0);
      if (std::abs(plain.now - floor) < 1e-9) continue;
      ++(plain.now > floor ? legal : plain.now > 0 ? tooThin : flipped);
      if (plain.now > floor) {
        ASSERT_NEAR(shape, plain.now, 1e-9);
      } else {
        ASSERT_LT(shape, 0) << plain.now << " where it was " << plain.old;
      }
    }
  }
  for (const std::size_t count : {legal, flipped, tooThin}) EXPECT_GT(count, 100u);
}

}  // namespace
}  // namespace qtet
