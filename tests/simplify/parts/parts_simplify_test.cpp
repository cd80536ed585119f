#include "simplify/parts/parts_simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stop_token>
#include <utility>
#include <vector>

#include "simplify/parts/cut_mesh.h"
#include "simplify/parts/metis_partition.h"
#include "tests/simplify/parts/small_parts.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

PartsFusion inParts(const LatticeMesh& mesh, const FusionOptions& options,
                    const PartsOptions& parts = testing::smallParts(400)) {
  LatticeMesh copy = mesh;
  Result<PartsFusion> out = simplifyInParts(std::move(copy), options, parts);
  EXPECT_TRUE(out) << out.error().text();
  return out ? std::move(*out) : PartsFusion{};
}

std::size_t cellsOf(const FusionHistory& history) {
  return testing::meshOfHistory(history, 0).tetrahedra.size();
}

TEST(InParts, noBandPassesTheWantedCells) {
  LatticeMesh mesh = testing::gridMesh(8, 2);
  for (std::vector<std::int32_t>& values : mesh.values) std::ranges::fill(values, 1);
  FusionOptions options;
  options.baseCells = 1000;  // of 3,072, all of which cost the same inside
  const PartsFusion fused = inParts(mesh, options);
  EXPECT_GT(fused.bands, 0u);
  EXPECT_LE(cellsOf(fused.history), 1000u);
  EXPECT_GT(cellsOf(fused.history), 950u);
}

TEST(InParts, aMeshIsCutFromSoManyCellsOnAndFarFromItsTarget) {
  const LatticeMesh mesh = testing::gridMesh(4, 2);  // 384 cells
  PartsOptions parts = testing::smallParts(48);
  FusionOptions options;
  options.baseCells = 100;
  parts.minParts = 8;
  EXPECT_GT(inParts(mesh, options, parts).bands, 0u);
  parts.minParts = 9;
  EXPECT_EQ(inParts(mesh, options, parts).bands, 0u);
  parts.minParts = 8;
  options.baseCells = 128;
  EXPECT_GT(inParts(mesh, options, parts).bands, 0u);
  options.baseCells = 129;  // more than a third
  EXPECT_EQ(inParts(mesh, options, parts).bands, 0u);
}

TEST(InParts, aMeshThatIsNotCutHasTheFusionsOfOnePiece) {
  const LatticeMesh mesh = testing::gridMesh(4, 2);
  const auto piece = simplify(mesh, {});
  ASSERT_TRUE(piece);
  testing::expectTheSame(inParts(mesh, {}, testing::smallParts(400)).history, *piece);
}

TEST(InParts, keptVerticesStay) {
  const LatticeMesh mesh = testing::gridMesh(8, 2);
  FusionOptions options;
  options.targetRatio = 0;
  for (VertexId v = 0; v < mesh.points.size(); v += 5) options.kept.push_back(v);
  const PartsFusion fused = inParts(mesh, options);
  EXPECT_GT(fused.bands, 0u);
  for (const Fusion& fusion : fused.history.fusions)
    for (std::size_t i = 0; i < fusion.k; ++i)
      ASSERT_TRUE(fusion.prey[i] >= mesh.points.size() || fusion.prey[i] % 5 != 0);
}

TEST(InParts, regionsAndCellFieldsComeThrough) {
  LatticeMesh mesh = testing::gridMesh(8, 2);
  testing::addCellFields(mesh);
  FusionOptions options;
  options.targetRatio = 0;
  options.regionField = 2;
  options.envelopeTolerance = 0;
  const PartsFusion fused = inParts(mesh, options);
  EXPECT_GT(fused.bands, 0u);
  for (std::uint32_t undone = 0; undone <= fused.history.levels; undone += 3)
    ASSERT_EQ(testing::whatIsWrongWith(testing::meshOfHistory(fused.history, undone)), "");
}

TEST(InParts, aStopEndsThem) {
  std::stop_source stop;
  FusionOptions options;
  options.stop = stop.get_token();
  options.progress = [&](double) { stop.request_stop(); };  // behind the first band
  LatticeMesh mesh = testing::gridMesh(8, 2);
  const auto out = simplifyInParts(std::move(mesh), options, testing::smallParts(400));
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, ErrorCode::kCancelled);
}

TEST(MetisPartitioner, cutsAlikeForAnyNumberOfThreads) {
  const LatticeMesh lattice = testing::gridMesh(8, 4);
  const FusionMesh mesh(lattice);
  Workers one(1), two(2);
  const CutMesh cut = cutMesh(mesh, metisPartitioner(), 200, 0, {}, one, 1000);
  EXPECT_EQ(cut.parts, cutMesh(mesh, metisPartitioner(), 200, 0, {}, two, 1000).parts);
  EXPECT_GT(cut.parts.size(), 12u);
  for (const std::vector<CellId>& part : cut.parts) EXPECT_LT(part.size(), 260u);
  EXPECT_GT(cut.innerShare, 0.1);
}

}  // namespace
}  // namespace qtet
