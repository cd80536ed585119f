#include "simplify/legality/fusion_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "codec/mesh/boundary.h"
#include "codec/mesh/placement.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/legality/full_link_check.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::gridMesh;
using testing::meshOfHistory;

TEST(FusionCheck, anEdgeBetweenTwoBoundariesIsNotFused) {
  // The wall between a void and the outside is one cube thick: every edge through it joins two
  // boundary components.
  const LatticeMesh mesh =
      gridMesh(3, 1, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
  const FusionMesh live(mesh);
  FusionCheck test(live);
  std::size_t edges = 0;
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const auto outer = [&](VertexId v) {
          return std::ranges::any_of(mesh.points[v],
                                     [](std::int32_t x) { return x == 0 || x == 192; });
        };
        if (outer(t[i]) == outer(t[j])) continue;
        ++edges;
        EXPECT_FALSE(test.gather({2, {t[i], t[j], 0, 0}}) && test.keepsTopology());
      }
  EXPECT_GT(edges, 0u);
}

TEST(FusionCheck, theEnvelopeIsClosedButNothingOutsideBelongsToIt) {
  const LatticeMesh mesh = gridMesh(2, 1);
  const FusionMesh live(mesh);
  FusionCheck test(live);
  for (VertexId v = 0; v < mesh.points.size(); ++v) {
    if (mesh.points[v] != LatticePoint{0, 64, 64}) continue;
    const auto& cell = live.cell(live.star(v)[0]);
    const VertexId w = cell[0] == v ? cell[1] : cell[0];
    ASSERT_TRUE(test.gather({2, {v, w, 0, 0}}));
    EXPECT_TRUE(test.insideEnvelope({0, 64, 64})) << "on the boundary is inside";
    EXPECT_FALSE(test.insideEnvelope({-1, 64, 64}));
    LatticePoint projected{};
    ASSERT_TRUE(test.projectInside({-5.3, 60, 60}, projected));
    EXPECT_TRUE(test.insideEnvelope(projected));
    EXPECT_EQ(projected[0], 0);
  }
}

/// How many edges of the mesh may be fused. The link condition on edges is compared with the test
/// of the whole link, which shares nothing with it.
std::size_t legalEdges(const LatticeMesh& mesh) {
  const FusionMesh live(mesh);
  FusionCheck test(live);
  FullLinkCheck full;
  std::size_t legal = 0;
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Prey edge{2, {t[i], t[j], 0, 0}};
        if (live.singular(t[i]) || live.singular(t[j]) || !test.gather(edge)) continue;
        const bool keeps = test.keepsTopology();
        EXPECT_EQ(keeps, full.passes(live, edge, test.star())) << t[i] << "-" << t[j];
        legal += keeps;
      }
  return legal;
}

TEST(FusionCheck, theLinkConditionOfAnEdgeAgreesWithTheWholeLink) {
  EXPECT_GT(legalEdges(gridMesh(5, 1)), 0u);
  EXPECT_GT(
      legalEdges(gridMesh(5, 2, [](int i, int j, int k) { return i != 2 || j != 2 || k != 2; })),
      0u);
  EXPECT_GT(legalEdges(gridMesh(6, 3, [](int i, int j, int) { return i < 2 || j < 2 || i > 3; })),
            0u);
  EXPECT_GT(legalEdges(gridMesh(5, 4, [](int i, int j, int k) { return (i + j + k) % 4 != 0; })),
            0u)
      << "pinched in edges and points";
}

/// A spool: four vertices on its axis, `ring` round it, so that the edge in the middle of the axis
/// has `ring` cells.
LatticeMesh spool(VertexId ring) {
  LatticeMesh mesh;
  mesh.lattice.bits = 16;
  for (const std::int32_t z : {0, 10000, 20000, 30000}) mesh.points.push_back({30000, 30000, z});
  for (VertexId i = 0; i < ring; ++i) {
    const double angle = 2 * std::numbers::pi * i / ring;
    mesh.points.push_back({static_cast<std::int32_t>(30000 + 20000 * std::cos(angle)),
                           static_cast<std::int32_t>(30000 + 20000 * std::sin(angle)), 15000});
  }
  for (VertexId z = 0; z < 3; ++z)
    for (VertexId i = 0; i < ring; ++i)
      mesh.tetrahedra.push_back({4 + i, 4 + (i + 1) % ring, z, z + 1});
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  return mesh;
}

TEST(FusionCheck, theLinkConditionAgreesWhereAnEdgeHasMoreCellsThanAWordHasBits) {
  for (const VertexId ring : {3u, 4u, 63u, 64u, 65u, 120u}) {
    const LatticeMesh mesh = spool(ring);
    EXPECT_GT(legalEdges(mesh), 0u) << ring;
    const FusionMesh live(mesh);
    FusionCheck test(live);
    ASSERT_TRUE(test.gather({2, {1, 2, 0, 0}}));
    EXPECT_TRUE(test.keepsTopology()) << ring;
  }
}

TEST(FusionCheck, theEnvelopeOfSmallNumbersIsThatOfLargeOnes) {
  LatticeMesh mesh = gridMesh(4, 5, [](int i, int j, int k) { return (i + j + k) % 4 != 0; });
  const FusionMesh small(mesh);
  mesh.lattice.bits = 17;  // more than doubles are sure to hold; these points they do
  const FusionMesh large(mesh);
  FusionCheck one(small), other(large);
  std::mt19937 random(5);
  const auto coordinate = [&] { return 1 + 0.001 * static_cast<double>(random() % 255000); };
  std::size_t inside = 0, projected = 0;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const Prey edge{2, {t[0], t[1], 0, 0}};
    if (!one.gatherBoundary(edge) || !other.gatherBoundary(edge)) continue;
    for (int trial = 0; trial < 5; ++trial) {
      const Vector3 p{coordinate(), coordinate(), coordinate()};
      const LatticePoint rounded{static_cast<std::int32_t>(p[0]), static_cast<std::int32_t>(p[1]),
                                 static_cast<std::int32_t>(p[2])};
      ASSERT_EQ(one.insideEnvelope(rounded), other.insideEnvelope(rounded));
      inside += one.insideEnvelope(rounded);
      LatticePoint here{}, there{};
      const bool isProjected = one.projectInside(p, here);
      ASSERT_EQ(isProjected, other.projectInside(p, there));
      if (isProjected) {
        ASSERT_EQ(here, there);
      }
      projected += isProjected;
    }
  }
  EXPECT_GT(inside, 10u);
  EXPECT_GT(projected, 2 * inside);
}

TEST(FusionCheck, theLinkConditionAgreesOnMeshesThatCanHardlyBeFusedFurther) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    FusionOptions options;
    options.targetRatio = 0;
    const auto history =
        simplify(gridMesh(6, seed,
                          [&](int i, int j, int k) {
                            return i != 3 || j != static_cast<int>(seed) || (seed > 2 && k == 3);
                          }),
                 options);
    ASSERT_TRUE(history);
    for (const std::uint32_t undone : {0u, 3u, 9u})
      (void)legalEdges(meshOfHistory(*history, std::min(undone, history->levels)));
  }
}

TEST(FusionCheck, measuresShapeAndRefusesFlips) {
  const LatticeMesh mesh = gridMesh(4, 1);
  const FusionMesh live(mesh);
  FusionCheck test(live);
  std::size_t inner = 0;
  for (VertexId v = 0; v < mesh.points.size(); ++v) {
    if (live.onBoundary(v)) continue;
    const auto& cell = live.cell(live.star(v)[0]);
    const VertexId w = cell[0] == v ? cell[1] : cell[0];
    if (live.onBoundary(w) || !test.gather({2, {v, w, 0, 0}})) continue;
    ++inner;
    EXPECT_GT(test.oldShape(), 0.1);
    EXPECT_LE(test.oldShape(), 1);
    const double shape = test.shapeAt(mesh.points[v]);
    EXPECT_LE(shape, 1);
    EXPECT_EQ(test.shapeAt(mesh.points[v], 0.99 * shape), shape);
    EXPECT_LT(test.shapeAt(mesh.points[v], 1.01 * std::abs(shape) + 0.01), 0)
        << "worse than what was asked for";
    EXPECT_FALSE(test.flipsAt(mesh.points[v], 1));
    EXPECT_TRUE(test.flipsAt({-1000, -1000, -1000}, 1));
    EXPECT_LT(test.shapeAt({0, 0, 0}), 0) << "far outside the star every cell on this side flips";
  }
  EXPECT_GT(inner, 0u);
}

TEST(FusionCheck, whatWasAskedBeforeHasNoSay) {
  const LatticeMesh mesh = gridMesh(4, 2);
  const FusionMesh live(mesh);
  FusionCheck test(live), fresh(live);
  std::size_t flipped = 0, legal = 0;
  for (VertexId v = 0; v < mesh.points.size(); ++v) {
    const auto& cell = live.cell(live.star(v)[0]);
    const Prey prey{2, {v, cell[0] == v ? cell[1] : cell[0], 0, 0}};
    if (!test.gather(prey)) continue;
    std::vector<LatticePoint> points;
    for (const VertexId at : test.star().link)
      if (at != kGhost)
        points.insert(points.end(), {mesh.points[at], quarter(mesh.points[v], mesh.points[at])});
    for (const LatticePoint& p : points) {
      ASSERT_TRUE(fresh.gather(prey));
      const bool flips = fresh.flipsAt(p, 3);
      EXPECT_EQ(test.flipsAt(p, 3), flips);
      EXPECT_EQ(flips, fresh.flipsAt(p, 1) || fresh.flipsAt(p, 2));
      const double shape = fresh.shapeAt(p);
      EXPECT_EQ(test.shapeAt(p), shape);
      EXPECT_TRUE(!flips || shape < 0);
      flipped += flips, legal += shape > 0;
    }
  }
  EXPECT_GT(flipped, 0u);
  EXPECT_GT(legal, 0u);
}

}  // namespace
}  // namespace qtet
