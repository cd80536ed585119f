#include "simplify/fusion_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "codec/placement.h"
#include "simplify/full_link_test.h"
#include "simplify/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::gridMesh;
using testing::meshOfHistory;

TEST(FusionTest, anEdgeBetweenTwoBoundariesIsNotFused) {
  // The wall between a void and the outside is one cube thick: every edge through it joins two boundary components.
  const LatticeMesh mesh = gridMesh(3, 1, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
  const FusionMesh live(mesh);
  FusionTest test(live);
  std::size_t edges = 0;
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const auto outer = [&](VertexId v) {
          return std::ranges::any_of(mesh.points[v], [](std::int32_t x) { return x == 0 || x == 192; });
        };
        if (outer(t[i]) == outer(t[j])) continue;
        ++edges;
        EXPECT_FALSE(test.gather({2, {t[i], t[j], 0, 0}}) && test.keepsTopology());
      }
  EXPECT_GT(edges, 0u);
}

TEST(FusionTest, theEnvelopeIsClosedButNothingOutsideBelongsToIt) {
  const LatticeMesh mesh = gridMesh(2, 1);
  const FusionMesh live(mesh);
  FusionTest test(live);
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

/// How many edges of the mesh may be fused; the link condition on edges is held against the test of the whole link, which shares nothing with it.
std::size_t legalEdges(const LatticeMesh& mesh) {
  const FusionMesh live(mesh);
  FusionTest test(live);
  FullLinkTest full;
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

TEST(FusionTest, theLinkConditionOfAnEdgeAgreesWithTheWholeLink) {
  EXPECT_GT(legalEdges(gridMesh(5, 1)), 0u);
  EXPECT_GT(legalEdges(gridMesh(5, 2, [](int i, int j, int k) { return i != 2 || j != 2 || k != 2; })), 0u);
  EXPECT_GT(legalEdges(gridMesh(6, 3, [](int i, int j, int) { return i < 2 || j < 2 || i > 3; })), 0u);
  EXPECT_GT(legalEdges(gridMesh(5, 4, [](int i, int j, int k) { return (i + j + k) % 4 != 0; })), 0u) << "pinched in edges and points";
}

TEST(FusionTest, theLinkConditionAgreesOnMeshesThatCanHardlyBeFusedFurther) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    FusionOptions options;
    options.targetRatio = 0;
    const auto history = simplify(
        gridMesh(6, seed, [&](int i, int j, int k) { return i != 3 || j != static_cast<int>(seed) || (seed > 2 && k == 3); }), options);
    ASSERT_TRUE(history);
    for (const std::uint32_t undone : {0u, 3u, 9u}) (void)legalEdges(meshOfHistory(*history, std::min(undone, history->levels)));
  }
}

TEST(FusionTest, measuresShapeAndRefusesFlips) {
  const LatticeMesh mesh = gridMesh(4, 1);
  const FusionMesh live(mesh);
  FusionTest test(live);
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
    EXPECT_LT(test.shapeAt(mesh.points[v], 1.01 * std::abs(shape) + 0.01), 0) << "worse than what was asked for";
    EXPECT_FALSE(test.flipsAt(mesh.points[v], 1));
    EXPECT_TRUE(test.flipsAt({-1000, -1000, -1000}, 1));
    EXPECT_LT(test.shapeAt({-1000, -1000, -1000}), 0) << "far outside the star every cell on this side flips";
  }
  EXPECT_GT(inner, 0u);
}

TEST(FusionTest, whatWasAskedBeforeHasNoSay) {
  const LatticeMesh mesh = gridMesh(4, 2);
  const FusionMesh live(mesh);
  FusionTest test(live), fresh(live);
  std::size_t flipped = 0, legal = 0;
  for (VertexId v = 0; v < mesh.points.size(); ++v) {
    const auto& cell = live.cell(live.star(v)[0]);
    const Prey prey{2, {v, cell[0] == v ? cell[1] : cell[0], 0, 0}};
    if (!test.gather(prey)) continue;
    std::vector<LatticePoint> points;
    for (const VertexId at : test.star().link)
      if (at != kGhost) points.insert(points.end(), {mesh.points[at], quarter(mesh.points[v], mesh.points[at])});
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
