// The mesh under simplification at a vertex of very many cells.
#include "simplify/mesh/fusion_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "simplify/mesh/workers.h"
#include "tests/support/meshes.h"
#include "tests/support/sanitizer.h"

namespace qtet {
namespace {

Star starOf(const FusionMesh& mesh, VertexId a, VertexId b) {
  Star out;
  for (const VertexId v : {a, b})
    for (const CellId c : mesh.star(v)) {
      const auto has = [&](VertexId w) {
        return std::ranges::find(mesh.cell(c), w) != mesh.cell(c).end();
      };
      for (const VertexId w : mesh.cell(c))
        if (w != a && w != b && std::ranges::find(out.link, w) == out.link.end())
          out.link.push_back(w);
      if (!(has(a) && has(b)))
        out.affected.push_back(c), out.labels.push_back(v == a ? 0 : 1);
      else if (v == a)
        out.deleted.push_back(c);
    }
  return out;
}

// The rim's edges go one by one; each takes cells from the axis' two vertices, whose stars hold
// nearly all that there are.
TEST(FusionMesh, cellsGoFromAHubWithoutALookAtAllOthers) {
  constexpr std::uint32_t kCells = 800'000 / testing::kStride, kFusions = kCells - 600;
  FusionMesh mesh(testing::fanMesh(kCells));
  VertexId last = 2 + kCells - 1;
  for (std::uint32_t i = 0; i < kFusions; ++i) {
    const VertexId next = 2 + kCells - 2 - i;
    last = mesh.fuse({2, {last, next, 0, 0}}, {mesh.point(next), {}}, starOf(mesh, last, next),
                     i / 1000);
  }
  EXPECT_EQ(mesh.liveTetrahedra(), kCells - kFusions);
  for (const VertexId hub : {0u, 1u}) {
    std::vector<CellId> star(mesh.star(hub).begin(), mesh.star(hub).end());
    EXPECT_EQ(star.size(), 2 * (kCells - kFusions)) << "cells and boundary triangles";
    std::ranges::sort(star);
    EXPECT_TRUE(std::ranges::adjacent_find(star) == star.end());
    EXPECT_EQ(mesh.boundaryStar(hub).size(), kCells - kFusions);
    for (const CellId c : mesh.boundaryStar(hub)) EXPECT_TRUE(mesh.isGhost(c));
    for (const CellId c : star)
      EXPECT_TRUE(std::ranges::find(mesh.cell(c), hub) != mesh.cell(c).end());
  }
  const FusionHistory history = mesh.takeHistory(kFusions / 1000 + 1);
  for (CellId c = 0; c < kFusions; ++c)
    EXPECT_EQ(history.live[c], c < kCells - kFusions - 1 || c == kCells - 1) << c;
}

TEST(FusionMesh, theBoundaryTrianglesOfAStarComeFirst) {
  constexpr std::uint32_t kCells = 40;
  FusionMesh mesh(testing::fanMesh(kCells));
  VertexId last = 2 + kCells - 1;
  for (std::uint32_t i = 0; i < 30; ++i) {
    const VertexId next = 2 + kCells - 2 - i;
    last = mesh.fuse({2, {last, next, 0, 0}}, {mesh.point(next), {}}, starOf(mesh, last, next), i);
    for (VertexId v = 0; v < mesh.vertexSlots(); ++v) {
      if (!mesh.alive(v)) continue;
      const auto star = mesh.star(v);
      const auto ghosts = mesh.boundaryStar(v);
      ASSERT_EQ(std::ranges::count_if(star, [&](CellId c) { return mesh.isGhost(c); }),
                std::ssize(ghosts));
      ASSERT_TRUE(std::ranges::all_of(
          ghosts, [&](CellId c) { return mesh.isGhost(c) && mesh.cell(c)[3] == kGhost; }));
      for (const CellId c : star)
        ASSERT_TRUE(std::ranges::find(mesh.cell(c), v) != mesh.cell(c).end());
      ASSERT_EQ(mesh.innerStar(v).size() + ghosts.size(), star.size());
      for (const CellId c : ghosts) {
        const Vector3 a = mesh.position(mesh.cell(c)[0]);
        const Vector3 normal =
            cross(mesh.position(mesh.cell(c)[1]) - a, mesh.position(mesh.cell(c)[2]) - a);
        ASSERT_EQ(mesh.plane(c).normal, normal) << "a plane follows its triangle";
        ASSERT_DOUBLE_EQ(mesh.plane(c).inverseLength,
                         dot(normal, normal) > 0 ? 1 / std::sqrt(dot(normal, normal)) : 0);
      }
    }
  }
}

}  // namespace
}  // namespace qtet
