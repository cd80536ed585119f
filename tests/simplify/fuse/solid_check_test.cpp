// The checker of solids on solids whose properties are known, and on broken ones: what checks the
// simplifier has to be able to fail.
#include "tests/support/solid_check.h"

#include <gtest/gtest.h>

#include "codec/mesh/boundary.h"
#include "tests/support/exact_geometry.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::checkSolid;
using testing::gridMesh;
using testing::SolidReport;
using testing::topologyChange;
using testing::whatIsOutside;

using Betti = std::array<std::int64_t, 4>;

TEST(SolidCheck, aBlockIsABallAndItsVolumeIsKnown) {
  const SolidReport report = checkSolid(gridMesh(3, 1));
  EXPECT_EQ(report.faults(), "");
  EXPECT_EQ(report.betti, (Betti{1, 0, 0, 0}));
  EXPECT_EQ(report.boundaryEuler, (std::vector<std::int64_t>{2}));
  EXPECT_EQ(report.faceComponents, 1);
  EXPECT_EQ(report.volume6, 6 * 192 * 192 * 192);
  EXPECT_TRUE(report.singularVertices.empty());
}

TEST(SolidCheck, countsTunnelsCavitiesAndParts) {
  const SolidReport tunnels =
      checkSolid(gridMesh(5, 1, [](int i, int j, int) { return i % 2 == 0 || j % 2 == 0; }));
  EXPECT_EQ(tunnels.faults(), "");
  EXPECT_EQ(tunnels.betti, (Betti{1, 4, 0, 0}));
  EXPECT_EQ(tunnels.boundaryEuler, (std::vector<std::int64_t>{2 - 2 * 4}));

  const SolidReport cavity =
      checkSolid(gridMesh(3, 1, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; }));
  EXPECT_EQ(cavity.betti, (Betti{1, 0, 1, 0}));
  EXPECT_EQ(cavity.boundaryEuler, (std::vector<std::int64_t>{2, 2}));

  const SolidReport parts = checkSolid(gridMesh(3, 1, [](int i, int, int) { return i != 1; }));
  EXPECT_EQ(parts.betti, (Betti{2, 0, 0, 0}));
  EXPECT_EQ(parts.faceComponents, 2);
}

TEST(SolidCheck, findsWhereASolidTouchesItself) {
  const SolidReport edge =
      checkSolid(gridMesh(2, 1, [](int i, int j, int k) { return k == 0 && i == j; }));
  EXPECT_EQ(edge.faults(), "");
  EXPECT_EQ(edge.betti, (Betti{1, 0, 0, 0}));
  EXPECT_EQ(edge.faceComponents, 2);
  EXPECT_EQ(edge.singularEdges.size(), 1u);
  EXPECT_EQ(edge.singularVertices.size(), 2u);

  const SolidReport corner =
      checkSolid(gridMesh(2, 1, [](int i, int j, int k) { return i == j && j == k; }));
  EXPECT_TRUE(corner.singularEdges.empty());
  EXPECT_EQ(corner.singularVertices.size(), 1u);
  EXPECT_NE(topologyChange(corner, edge), "");
}

TEST(SolidCheck, findsCellsThatAreTurnedOver) {
  LatticeMesh mesh = gridMesh(2, 1);
  std::swap(mesh.tetrahedra[3][0], mesh.tetrahedra[3][1]);
  EXPECT_EQ(checkSolid(mesh).notPositive, 1u);
  EXPECT_GT(checkSolid(mesh).facesOneSided, 0u);
}

TEST(SolidCheck, findsAFaceOfThreeCells) {
  LatticeMesh mesh = gridMesh(2, 1);
  Tetrahedron t = mesh.tetrahedra[0];
  t[0] = static_cast<VertexId>(mesh.points.size());
  mesh.points.push_back({120, 3, 5});
  mesh.tetrahedra.push_back(t);
  EXPECT_EQ(checkSolid(mesh).facesOfThree, 1u);
}

TEST(SolidCheck, findsABoundaryThatIsNotTheCells) {
  LatticeMesh mesh = gridMesh(2, 1);
  std::swap(mesh.boundary[0][0], mesh.boundary[0][1]);
  EXPECT_FALSE(checkSolid(mesh).boundaryAgrees);
}

/// Two positive cells with vertices of their own, the second one moved.
LatticeMesh twoCells(const LatticePoint& by) {
  LatticeMesh mesh;
  for (const LatticePoint& p : {LatticePoint{0, 0, 0}, {12, 0, 0}, {0, 12, 0}, {0, 0, 12}})
    mesh.points.push_back(p);
  for (std::size_t v = 0; v < 4; ++v) {
    LatticePoint p = mesh.points[v];
    for (std::size_t k = 0; k < 3; ++k) p[k] += by[k];
    mesh.points.push_back(p);
  }
  mesh.tetrahedra = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  return mesh;
}

TEST(SolidCheck, tellsOverlapFromContact) {
  EXPECT_EQ(checkSolid(twoCells({20, 0, 0})).faults(), "");
  const SolidReport touching = checkSolid(twoCells({12, 0, 0}));
  EXPECT_EQ(touching.overlaps, 0u);
  EXPECT_GT(touching.crossings, 0u)
      << "they touch in a point that is a vertex of both, but not the same vertex";
  EXPECT_EQ(checkSolid(twoCells({11, 0, 0})).overlaps, 1u);
  EXPECT_EQ(checkSolid(twoCells({0, 0, 0})).overlaps, 1u)
      << "no face's plane and no edges separate a cell from its double";
}

TEST(SolidCheck, findsTrianglesThatFoldBackOnTheirNeighbour) {
  // Both cells stand on one plane, on either side of it. The lower one's face lies all in the upper
  // one's face and shares one edge with it.
  LatticeMesh mesh;
  mesh.points = {{10, 10, 10}, {20, 10, 10}, {10, 20, 10}, {12, 12, 20}, {12, 14, 10}, {12, 12, 0}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 4, 1, 5}};
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  const SolidReport report = checkSolid(mesh);
  EXPECT_EQ(report.notPositive, 0u);
  EXPECT_EQ(report.overlaps, 0u);
  EXPECT_EQ(report.crossings, 3u)
      << "the lower cell's three faces at the vertex that is not shared";
}

TEST(SolidCheck, containmentIsExact) {
  const LatticeMesh block = gridMesh(3, 1);
  EXPECT_EQ(whatIsOutside(block, block), "");
  LatticeMesh inner = twoCells({40, 40, 40});
  EXPECT_EQ(whatIsOutside(inner, block), "");
  inner.points[7][2] = 192;  // on the block's surface
  EXPECT_EQ(whatIsOutside(inner, block), "");
  inner.points[7][2] = 193;
  EXPECT_NE(whatIsOutside(inner, block), "");
  EXPECT_EQ(whatIsOutside(twoCells({400, 0, 0}), block), "cell 1 lies outside");
}

TEST(SolidCheck, aCellAcrossACavityIsNotContained) {
  const LatticeMesh hollow =
      gridMesh(3, 1, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
  EXPECT_EQ(whatIsOutside(hollow, gridMesh(3, 1)), "");
  EXPECT_NE(whatIsOutside(gridMesh(3, 1), hollow), "")
      << "its cells fill the cavity exactly: none crosses the boundary";
}

TEST(ExactGeometry, segmentsAndTrianglesAreClosed) {
  using testing::Point;
  using testing::segmentMeetsTriangle;
  const std::array<Point, 3> t{{{0, 0, 0}, {6, 0, 0}, {0, 6, 0}}};
  EXPECT_TRUE(segmentMeetsTriangle({1, 1, -1}, {1, 1, 1}, t));
  EXPECT_TRUE(segmentMeetsTriangle({3, 3, 0}, {3, 3, 5}, t)) << "an end on an edge";
  EXPECT_FALSE(segmentMeetsTriangle({4, 3, 0}, {4, 3, 5}, t));
  EXPECT_TRUE(segmentMeetsTriangle({-1, 1, 0}, {7, 1, 0}, t)) << "through it, in its plane";
  EXPECT_TRUE(segmentMeetsTriangle({1, 1, 0}, {2, 1, 0}, t)) << "within it";
  EXPECT_FALSE(segmentMeetsTriangle({4, 4, 0}, {7, 1, 0}, t)) << "beside it, in its plane";
  EXPECT_FALSE(segmentMeetsTriangle({1, 1, 1}, {1, 1, 4}, t));
}

}  // namespace
}  // namespace qtet
