#include "simplify/split/cell_mesh.h"

#include <gtest/gtest.h>

#include <vector>

namespace qtet {
namespace {

std::vector<VertexId> visited(std::uint8_t type, const std::vector<VertexId>& ids) {
  std::vector<VertexId> out;
  forEachId(type, std::span(ids), [&](VertexId v) { out.push_back(v); });
  return out;
}

TEST(CellMesh, aPolyhedronsCountsAreNotAmongItsVertices) {
  EXPECT_EQ(visited(kPolyhedronCell, {2, 3, 10, 11, 12, 4, 20, 21, 22, 23}),
            (std::vector<VertexId>{10, 11, 12, 20, 21, 22, 23}));
  EXPECT_EQ(visited(kPyramidCell, {2, 3, 10, 11, 12}), (std::vector<VertexId>{2, 3, 10, 11, 12}));
}

/// Pieces are joined before anybody has checked their cells.
TEST(CellMesh, aDamagedPolyhedronIsWalkedToItsEndAndNoFurther) {
  EXPECT_EQ(visited(kPolyhedronCell, {}), (std::vector<VertexId>{}));
  EXPECT_EQ(visited(kPolyhedronCell, {4}), (std::vector<VertexId>{}));
  EXPECT_EQ(visited(kPolyhedronCell, {4, 3}), (std::vector<VertexId>{}));
  EXPECT_EQ(visited(kPolyhedronCell, {4, 0, 0, 2, 7, 8}), (std::vector<VertexId>{7, 8}));
  EXPECT_EQ(visited(kPolyhedronCell, {4, 3, 10, 11}), (std::vector<VertexId>{10, 11}));
  EXPECT_EQ(visited(kPolyhedronCell, {4, 1, 10, kGhost, 11}), (std::vector<VertexId>{10, 11}));
}

TEST(CellMesh, renamingLeavesCountsAndWhatIsNoPointAlone) {
  CellMesh mesh;
  mesh.points.resize(5);
  mesh.addCell(kTetrahedronCell, std::vector<VertexId>{0, 1, 2, kGhost});
  mesh.addCell(kPolyhedronCell, std::vector<VertexId>{2, 3, 0, 1, 2, 3, 2, 3, 4});
  mesh.renamePoints(std::vector<VertexId>{4, 3, 2, 1, 0});
  EXPECT_EQ(mesh.vertices, (std::vector<VertexId>{4, 3, 2, kGhost, 2, 3, 4, 3, 2, 3, 2, 1, 0}));
}

}  // namespace
}  // namespace qtet
