#include "simplify/parts/cut_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/simplify/parts/small_parts.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using Parts = std::vector<std::vector<CellId>>;

struct Cut {
  explicit Cut(const FusionMesh& mesh, std::uint32_t band = 0, int threads = 1,
               std::size_t blockCells = kMaxBlockCells) {
    Workers workers(threads);
    const CutMesh made = cutMesh(mesh, testing::compactParts, 100, band, {}, workers, blockCells);
    parts = made.parts;
    isSeam = made.isSeam;
    innerShare = made.innerShare;
  }
  Parts parts;
  std::vector<std::uint8_t> isSeam;
  double innerShare = 0;
};

TEST(CutMesh, eachCellIsInOnePartAndASeamIsWhereSeveralMeet) {
  const LatticeMesh lattice = testing::gridMesh(5, 3);
  const FusionMesh mesh(lattice);
  const Cut cut(mesh);
  EXPECT_EQ(cut.parts.size(), 8u);  // 750 cells, rounded
  std::vector<int> count(lattice.tetrahedra.size(), 0);
  std::vector<std::set<std::size_t>> partsAt(lattice.points.size());
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    EXPECT_TRUE(std::ranges::is_sorted(cut.parts[p]));
    for (const CellId c : cut.parts[p]) {
      ++count[c];
      for (const VertexId v : lattice.tetrahedra[c]) partsAt[v].insert(p);
    }
  }
  EXPECT_EQ(std::ranges::count(count, 1), std::ssize(count));
  std::size_t inner = 0;
  for (VertexId v = 0; v < lattice.points.size(); ++v) {
    EXPECT_EQ(cut.isSeam[v] != 0, partsAt[v].size() > 1) << v;
    inner += partsAt[v].size() == 1;
  }
  EXPECT_DOUBLE_EQ(cut.innerShare,
                   static_cast<double>(inner) / static_cast<double>(lattice.points.size()));
}

TEST(CutMesh, blocksAreCutAlikeByAnyNumberOfThreadsAndElsewhereInTheNextBand) {
  const LatticeMesh lattice = testing::gridMesh(6, 4);
  const FusionMesh mesh(lattice);
  const Cut one(mesh, 0, 1, 400), two(mesh, 0, 2, 400), next(mesh, 1, 1, 400);
  EXPECT_EQ(one.parts, two.parts);
  EXPECT_NE(one.parts, next.parts);
  std::size_t cells = 0;
  for (const std::vector<CellId>& part : one.parts) cells += part.size();
  EXPECT_EQ(cells, lattice.tetrahedra.size());
}

TEST(CellGraph, cellsThatShareAFaceAreBesideEachOtherAndOldFacesAreDear) {
  const LatticeMesh lattice = testing::gridMesh(2, 1);
  const FusionMesh mesh(lattice);
  const std::vector<CellId> cells{0, 1, 2, 3, 4, 5};  // one cube's: a ring round its diagonal
  std::vector<std::uint8_t> old(lattice.points.size(), 0);
  for (const VertexId v : lattice.tetrahedra[0]) old[v] = 1;
  const CellGraph graph = cellGraphOf(mesh, cells, old);
  ASSERT_EQ(graph.begins.size(), 7u);
  EXPECT_EQ(graph.beside.size(), 12u);
  for (std::size_t i = 0; i < 6; ++i)
    for (auto at = static_cast<std::size_t>(graph.begins[i]);
         at < static_cast<std::size_t>(graph.begins[i + 1]); ++at) {
      const auto j = static_cast<std::size_t>(graph.beside[at]);
      std::int32_t common = 0, dear = 1;
      for (const VertexId v : lattice.tetrahedra[i])
        if (std::ranges::find(lattice.tetrahedra[j], v) != lattice.tetrahedra[j].end())
          ++common, dear += old[v] ? 3 : 0;
      EXPECT_EQ(common, 3);
      EXPECT_EQ(graph.weights[at], dear);
    }
}

}  // namespace
}  // namespace qtet
