#include "codec/mesh/link.h"

#include <gtest/gtest.h>

namespace qtet {
namespace {

void addOctahedron(Link& link, VertexId top, VertexId bottom) {
  for (VertexId i = 0; i < 4; ++i) link.add(i, (i + 1) % 4, top), link.add((i + 1) % 4, i, bottom);
}

TEST(Link, anOctahedronIsASphere) {
  Link link;
  link.clear(10);
  addOctahedron(link, 4, kGhost);
  ASSERT_TRUE(link.close());
  EXPECT_TRUE(link.isSphere());
  EXPECT_TRUE(link.hasGhost());
  EXPECT_EQ(link.vertices().size(), 6u);
  EXPECT_EQ(link.traversal().size(), 8u);
}

TEST(Link, aMissingTriangleLeavesItOpen) {
  Link link;
  link.clear(10);
  for (VertexId i = 0; i < 4; ++i) link.add(i, (i + 1) % 4, 4);
  EXPECT_FALSE(link.close());
}

TEST(Link, anEdgeMetTwiceInOneDirectionIsRefused) {
  Link link;
  link.clear(10);
  addOctahedron(link, 4, 5);
  link.add(0, 1, 6);
  EXPECT_FALSE(link.close());
}

TEST(Link, aTriangleThatMeetsAVertexTwiceIsRefused) {
  Link link;
  link.clear(10);
  addOctahedron(link, 4, 5);
  link.add(6, 6, 7), link.add(6, 7, 6);
  EXPECT_FALSE(link.close());
}

TEST(Link, anEdgeFromAVertexToItselfIsRefusedThoughItHasANeighbour) {
  Link link;
  link.clear(10);
  addOctahedron(link, 4, 5);
  link.add(6, 6, 7);
  EXPECT_FALSE(link.close());
}

TEST(Link, aSphereThatIsThereTwiceIsRefused) {
  Link link;
  link.clear(10);
  addOctahedron(link, 4, 5), addOctahedron(link, 4, 5);
  EXPECT_FALSE(link.close());
}

TEST(Link, edgesOfEarlierLinksAreForgottenHoweverManyThereWere) {
  Link link;
  link.clear(10);
  addOctahedron(link, 4, 5);
  ASSERT_TRUE(link.close());
  for (int turn = 0; turn < 32'766; ++turn) {
    link.clear(10);
    link.add(6, 7, 8), link.add(6, 8, 7), link.add(6, 9, 8), link.add(7, 8, 9);
    ASSERT_FALSE(link.close()) << turn;
  }
  link.clear(10);  // the turns begin anew
  for (VertexId i = 0; i < 4; ++i) link.add(i, (i + 1) % 4, 4);
  EXPECT_FALSE(link.close()) << "its lower half is of another link";
  for (VertexId i = 0; i < 4; ++i) link.add((i + 1) % 4, i, 5);
  EXPECT_TRUE(link.close());
}

TEST(Link, twoSpheresAreNotOne) {
  Link link;
  link.clear(20);
  addOctahedron(link, 4, 5);
  for (VertexId i = 10; i < 14; ++i)
    link.add(i, i == 13 ? 10 : i + 1, 14), link.add(i == 13 ? 10 : i + 1, i, 15);
  ASSERT_TRUE(link.close());
  EXPECT_FALSE(link.isSphere());
}

TEST(Link, spheresThatTouchInAVertexAreNoSphere) {
  Link link;
  link.clear(20);
  addOctahedron(link, 4, 5);
  for (VertexId i = 10; i < 14; ++i)
    link.add(i, i == 13 ? 10 : i + 1, 4), link.add(i == 13 ? 10 : i + 1, i, 15);
  ASSERT_TRUE(link.close());
  EXPECT_FALSE(link.isSphere());
}

TEST(Link, aTorusIsNoSphere) {
  Link link;
  link.clear(16);
  const auto at = [](VertexId i, VertexId j) { return (i % 4) * 4 + j % 4; };
  for (VertexId i = 0; i < 4; ++i)
    for (VertexId j = 0; j < 4; ++j)
      link.add(at(i, j), at(i + 1, j), at(i, j + 1)),
          link.add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  ASSERT_TRUE(link.close());
  EXPECT_FALSE(link.isSphere());
}

TEST(Link, startsAfreshForEachVertex) {
  Link link;
  for (int i = 0; i < 3; ++i) {
    link.clear(10);
    addOctahedron(link, 4, 5);
    ASSERT_TRUE(link.close());
    EXPECT_EQ(link.localOf(7), kNoNeighbour);
    EXPECT_NE(link.localOf(5), kNoNeighbour);
  }
}

}  // namespace
}  // namespace qtet
