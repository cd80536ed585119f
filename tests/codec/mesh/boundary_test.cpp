#include "codec/mesh/boundary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "codec/mesh/face_groups.h"
#include "codec/mesh/predicates.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

TEST(Boundary, aSingleCellHasFourFacesByOppositeCorner) {
  const std::vector<Tetrahedron> cells{{10, 11, 12, 13}};
  EXPECT_EQ(boundaryOf(cells),
            (std::vector<Triangle>{{11, 12, 13}, {10, 13, 12}, {10, 11, 13}, {10, 12, 11}}));
}

TEST(Boundary, facesLookAwayFromTheOppositeCorner) {
  const std::vector<LatticePoint> points{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}};
  const Tetrahedron cell{0, 1, 2, 3};
  ASSERT_EQ(orientation(points[0], points[1], points[2], points[3]), 1);
  for (int i = 0; i < 4; ++i) {
    const Triangle face = cellFace(cell, i);
    EXPECT_EQ(orientation(points[face[0]], points[face[1]], points[face[2]],
                          points[static_cast<std::size_t>(i)]),
              -1)
        << "corner " << i;
  }
}

TEST(Boundary, aSharedFaceIsInside) {
  const std::vector<Tetrahedron> cells{{0, 1, 2, 3}, {1, 2, 3, 4}};
  const std::vector<Triangle> boundary = boundaryOf(cells);
  EXPECT_EQ(boundary.size(), 6u);
  EXPECT_EQ(std::count(boundary.begin(), boundary.end(), (Triangle{1, 2, 3})), 0);
}

TEST(Boundary, nothingHasNoBoundary) { EXPECT_TRUE(boundaryOf({}).empty()); }

TEST(Boundary, ofAGridIsClosedAndConsistentlyOriented) {
  const LatticeMesh mesh = testing::gridMesh(5, 3);
  std::map<std::pair<VertexId, VertexId>, int> directed;
  for (const Triangle& t : boundaryOf(mesh.tetrahedra)) {
    for (std::size_t i = 0; i < 3; ++i) ++directed[{t[i], t[(i + 1) % 3]}];
  }
  EXPECT_EQ(directed.size(), 3u * 5 * 5 * 6 * 2);
  for (const auto& [edge, count] : directed) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(directed.count({edge.second, edge.first}), 1u);
  }
}

TEST(FaceGroups, everySideStandsInOneGroupTheLowerCellFirst) {
  const LatticeMesh mesh = testing::gridMesh(3, 1);
  std::vector<int> seen(mesh.tetrahedra.size() * 4, 0);
  FaceGroups(mesh.tetrahedra).forEach([&](std::span<const FaceSide> sides) {
    ASSERT_LE(sides.size(), 2u);
    ASSERT_TRUE(std::is_sorted(sides.begin(), sides.end()));
    for (const FaceSide side : sides) ++seen[side];
  });
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int count) { return count == 1; }));
}

}  // namespace
}  // namespace qtet
