// Bands: the k-d tree, and fusions that keep to its nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "codec/log/log_writer.h"
#include "simplify/fuse/band_nodes.h"
#include "simplify/fuse/kd_tree.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"
#include "tests/support/sanitizer.h"

namespace qtet {
namespace {

using testing::gridMesh;

TEST(KdTree, leavesAreAsLargeAsAskedAndBalanced) {
  EXPECT_EQ(kdDepth(8000, 8000), 0u);
  EXPECT_EQ(kdDepth(11000, 8000), 0u);
  EXPECT_EQ(kdDepth(12000, 8000), 1u);
  EXPECT_EQ(kdDepth(1 << 20, 1 << 13), 7u);
  EXPECT_EQ(kdDepth(std::size_t{1} << 40, 1), 18u);
  const LatticeMesh mesh = gridMesh(6, 1);
  std::map<std::uint32_t, std::size_t> sizes;
  for (const std::uint32_t leaf : kdLeaves(mesh.points, mesh.tetrahedra, 4)) ++sizes[leaf];
  ASSERT_EQ(sizes.size(), 16u);
  for (const auto& [leaf, size] : sizes) {
    EXPECT_LT(leaf, 16u);
    EXPECT_NEAR(static_cast<double>(size), static_cast<double>(mesh.tetrahedra.size()) / 16, 1);
  }
}

TEST(KdTree, theFirstSplitIsTheMedianOfTheLongestAxis) {
  LatticeMesh mesh = gridMesh(6, 1);
  for (LatticePoint& p : mesh.points) p[1] *= 2;
  const std::vector<std::uint32_t> leaf = kdLeaves(mesh.points, mesh.tetrahedra, 1);
  std::int32_t lower = 0, upper = INT32_MAX;
  for (std::size_t t = 0; t < leaf.size(); ++t) {
    std::int32_t sum = 0;
    for (const VertexId v : mesh.tetrahedra[t]) sum += mesh.points[v][1];
    leaf[t] == 0 ? lower = std::max(lower, sum) : upper = std::min(upper, sum);
  }
  EXPECT_LE(lower, upper);
}

class BandsOfAGrid : public ::testing::Test {
 protected:
  BandsOfAGrid() : mesh_(gridMesh(9, 4)) {
    options_.targetRatio = 0.02;
    options_.bands.cellsPerPacket = 300;
    auto history = simplify(mesh_, options_);
    EXPECT_TRUE(history);
    history_ = std::move(*history);
  }
  LatticeMesh mesh_;
  FusionOptions options_;
  FusionHistory history_;
};

TEST_F(BandsOfAGrid, everyFusionOfABandKeepsToOneNode) {
  const Bands& bands = history_.bands;
  EXPECT_EQ(bands.depth, 4u);
  ASSERT_GE(bands.ends.size(), 2u);
  ASSERT_EQ(bands.leaf.size(), history_.cells.size());
  std::vector<std::size_t> fusions(bands.ends.size() + 1);
  for (const Fusion& f : history_.fusions) {
    const auto band = static_cast<std::size_t>(std::ranges::upper_bound(bands.ends, f.level) -
                                               bands.ends.begin());
    ++fusions[band];
    if (band == bands.ends.size()) continue;
    const std::uint32_t depth = bands.depth - static_cast<std::uint32_t>(band);
    const std::uint32_t node = bands.node(history_.affectedCells[f.firstAffected], depth);
    for (std::uint32_t i = 0; i < f.affectedCount; ++i)
      ASSERT_EQ(bands.node(history_.affectedCells[f.firstAffected + i], depth), node);
    for (std::uint32_t i = 0; i < f.deletedCount; ++i)
      ASSERT_EQ(bands.node(history_.deletedCells[f.firstDeleted + i], depth), node);
  }
  for (const std::size_t n : fusions) EXPECT_GT(n, 0u);
}

TEST_F(BandsOfAGrid, aBoundaryTriangleHasTheLeafOfItsTetrahedron) {
  for (std::size_t i = 0; i < mesh_.boundary.size(); ++i) {
    const Triangle& t = mesh_.boundary[i];
    const auto behind = std::ranges::find_if(mesh_.tetrahedra, [&](const Tetrahedron& c) {
      return std::ranges::all_of(t, [&](VertexId v) { return std::ranges::find(c, v) != c.end(); });
    });
    ASSERT_EQ(history_.bands.leaf[mesh_.tetrahedra.size() + i],
              history_.bands.leaf[static_cast<std::size_t>(behind - mesh_.tetrahedra.begin())]);
  }
}

TEST_F(BandsOfAGrid, threadsChangeNothing) {
  options_.threads = 3;
  const auto other = simplify(mesh_, options_);
  ASSERT_TRUE(other);
  const auto one = encodeLog(history_, {}), three = encodeLog(*other, {});
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->bytes, three->bytes);
}

TEST_F(BandsOfAGrid, aMeshOfOneLeafHasNoBands) {
  options_.bands.cellsPerPacket = mesh_.tetrahedra.size();
  const auto history = simplify(mesh_, options_);
  ASSERT_TRUE(history);
  EXPECT_TRUE(history->bands.ends.empty());
  options_.bands = {};
  const auto stream = simplify(mesh_, options_);
  ASSERT_TRUE(stream);
  EXPECT_EQ(encodeLog(*history, {})->bytes, encodeLog(*stream, {})->bytes);
}

TEST(BandNodes, aBoundaryTriangleFindsItsCellAlsoAtAHubOfAMillionCells) {
  const LatticeMesh mesh = testing::fanMesh(500'000 / testing::kStride);
  const FusionMesh live(mesh);
  BandNodes nodes(live, mesh, 1000);
  nodes.begin(live);
  EXPECT_FALSE(nodes.allows(0, 1)) << "the axis belongs to every node";
  const Bands bands = nodes.take();
  ASSERT_EQ(bands.leaf.size(), mesh.tetrahedra.size() + mesh.boundary.size());
  for (std::size_t b = 0; b < mesh.boundary.size(); b += 997) {
    const auto isBehind = [&](const Tetrahedron& t) {
      return std::ranges::all_of(mesh.boundary[b],
                                 [&](VertexId v) { return std::ranges::find(t, v) != t.end(); });
    };
    const auto behind = std::ranges::find_if(mesh.tetrahedra, isBehind);
    EXPECT_EQ(bands.leaf[mesh.tetrahedra.size() + b],
              bands.leaf[static_cast<std::size_t>(behind - mesh.tetrahedra.begin())]);
  }
}

}  // namespace
}  // namespace qtet
