// The projection into the boundary envelope beside a plain one, face after face.
#include "simplify/legality/boundary_envelope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "codec/mesh/boundary.h"
#include "tests/support/exact_geometry.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

constexpr double kReach = 65535;  // of 16 bits

testing::Point exact(const LatticePoint& p) { return {p[0], p[1], p[2]}; }

/// The boundary triangles round a prey in the envelope's order: each prey vertex' own, unless an
/// earlier one has it.
std::vector<Triangle> facesRound(const FusionMesh& mesh, const Prey& prey) {
  std::vector<Triangle> out;
  for (std::size_t i = 0; i < prey.k; ++i)
    for (const CellId c : mesh.boundaryStar(prey.vertex[i])) {
      const auto& cell = mesh.cell(c);
      const auto isIn = [&](VertexId v) { return std::ranges::find(cell, v) != cell.end(); };
      if (std::ranges::none_of(prey.vertices().first(i), isIn))
        out.push_back({cell[0], cell[1], cell[2]});
    }
  return out;
}

/// BoundaryEnvelope::project without tolerance: one face at a time, and whether a point lies
/// outside is asked in integers.
bool plainProject(const FusionMesh& mesh, const std::vector<Triangle>& faces, Vector3 p,
                  LatticePoint& inside) {
  for (int step = 0; step <= 8; ++step) {
    for (std::size_t a = 0; a < 3; ++a)
      inside[a] = static_cast<std::int32_t>(std::clamp(p[a] + 0.5, 0.0, kReach));
    double farthest = -1;
    Vector3 back{};
    for (const Triangle& t : faces) {
      if (testing::sideOf(exact(mesh.point(t[0])), exact(mesh.point(t[1])), exact(mesh.point(t[2])),
                          exact(inside)) <= 0)
        continue;
      const Vector3 a = mesh.position(t[0]),
                    normal = cross(mesh.position(t[1]) - a, mesh.position(t[2]) - a);
      const double over = 1 / std::sqrt(dot(normal, normal));
      const double outside =
          (dot(normal, toVector(inside) - a) + dot(normal, p - toVector(inside))) * over;
      if (std::abs(outside) > farthest)
        farthest = std::abs(outside), back = (outside * over) * normal;
      if (step >= 4) back = back + (0.87 * over) * normal;
    }
    if (farthest < 0) return true;
    p = p - back;
  }
  return false;
}

/// A cone over an octagon with corners at (2, 1), (1, 2), ... Every second one of its eight side
/// faces has the same slope, so points on the axis are equally far from four of them. The seed
/// decides the order of the cells.
LatticeMesh cone(std::uint32_t seed) {
  LatticeMesh mesh;
  mesh.lattice.bits = 16;
  mesh.points = {{1000, 1000, 0}, {1000, 1000, 150}};
  for (const auto& [x, y] : {std::pair{200, 100},
                             {100, 200},
                             {-100, 200},
                             {-200, 100},
                             {-200, -100},
                             {-100, -200},
                             {100, -200},
                             {200, -100}})
    mesh.points.push_back({1000 + x, 1000 + y, 0});
  for (VertexId i = 0; i < 8; ++i) mesh.tetrahedra.push_back({0, 2 + i, 2 + (i + 1) % 8, 1});
  std::mt19937 random(seed);
  std::ranges::shuffle(mesh.tetrahedra, random);
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  return mesh;
}

TEST(BoundaryEnvelope, ofEquallyFarFacesTheFirstOneCounts) {
  std::array<std::size_t, 2> toSide{};
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const LatticeMesh lattice = cone(seed);
    const FusionMesh mesh(lattice);
    const Prey prey{2, {1, 0, 0, 0}};
    BoundaryEnvelope envelope(mesh, -1);
    envelope.gather(prey);
    for (int z = 151; z < 200; ++z) {
      const Vector3 above{1000, 1000, z + 0.25};
      LatticePoint plain{}, ours{};
      const bool is = plainProject(mesh, facesRound(mesh, prey), above, plain);
      ASSERT_EQ(envelope.project(above, ours), is);
      if (!is) continue;
      ASSERT_EQ(ours, plain) << "seed " << seed << ", " << z;
      for (std::size_t a = 0; a < 2; ++a) toSide[a] += ours[a] != 1000;
    }
  }
  EXPECT_GT(toSide[0], 100u) << "the order of the faces does not show";
  EXPECT_GT(toSide[1], 100u) << "the order of the faces does not show";
}

/// Six times the signed volume between the triangles and the place 0, with the prey at d.
double volume6(const FusionMesh& mesh, const std::vector<Triangle>& faces, const Prey& prey,
               const Vector3* d) {
  double out = 0;
  for (const Triangle& t : faces) {
    std::array<Vector3, 3> at{};
    int moved = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool isPrey = std::ranges::find(prey.vertices(), t[i]) != prey.vertices().end();
      moved += isPrey;
      at[i] = isPrey && d ? *d : mesh.position(t[i]);
    }
    if (!d || moved == 1) out += dot(at[0], cross(at[1], at[2]));
  }
  return out;
}

TEST(BoundaryEnvelope, volumeChangesAsTheTrianglesSay) {
  const LatticeMesh lattice =
      testing::gridMesh(4, 5, [](int i, int j, int k) { return (i + j + k) % 4 != 0; });
  const FusionMesh mesh(lattice);
  BoundaryEnvelope envelope(mesh, -1);
  const Vector3 d{3, -2, 5};
  std::size_t changed = 0;
  for (const Tetrahedron& t : lattice.tetrahedra)
    for (std::uint8_t k = 2; k <= 4; ++k) {
      const Prey prey{k, t};
      envelope.gather(prey);
      const VolumeChange found = envelope.volumeChange();
      const std::vector<Triangle> faces = facesRound(mesh, prey);
      EXPECT_EQ(found.triangles, faces.size());
      const Vector3 there = mesh.position(prey.vertex[0]) + d;
      // the star's outer edges are the same before and after, so no place matters
      const double expected =
          (volume6(mesh, faces, prey, &there) - volume6(mesh, faces, prey, nullptr)) / 6;
      EXPECT_NEAR(dot(found.slope, d) + found.change, expected, 1e-6 * (1 + std::abs(expected)));
      changed += expected != 0;
    }
  EXPECT_GT(changed, 100u);
}

TEST(BoundaryEnvelope, projectsAsThePlainOneDoes) {
  const LatticeMesh lattice =
      testing::gridMesh(4, 5, [](int i, int j, int k) { return (i + j + k) % 4 != 0; });
  const FusionMesh mesh(lattice);
  BoundaryEnvelope envelope(mesh, -1);
  std::mt19937 random(3);
  const auto coordinate = [&] { return 0.001 * static_cast<double>(random() % 256000); };
  std::size_t inside = 0, projected = 0, lost = 0;
  for (const Tetrahedron& t : lattice.tetrahedra)
    for (std::uint8_t k = 2; k <= 4; ++k) {
      const Prey prey{k, t};
      envelope.gather(prey);
      const std::vector<Triangle> faces = facesRound(mesh, prey);
      const Vector3 p{coordinate(), coordinate(), coordinate()};
      LatticePoint plain{}, ours{};
      const bool is = plainProject(mesh, faces, p, plain);
      ASSERT_EQ(envelope.project(p, ours), is);
      if (is) {
        ASSERT_EQ(ours, plain);
        EXPECT_TRUE(envelope.holds(ours));
      }
      const LatticePoint start{static_cast<std::int32_t>(std::lround(p[0])),
                               static_cast<std::int32_t>(std::lround(p[1])),
                               static_cast<std::int32_t>(std::lround(p[2]))};
      ASSERT_EQ(envelope.holds(start), is && plain == start);
      inside += is && plain == start, projected += is && plain != start, lost += !is;
    }
  for (const std::size_t count : {inside, projected, lost}) EXPECT_GT(count, 50u);
}

}  // namespace
}  // namespace qtet
