// Meshes of real simulations, where the environment variable QTET_DATA names a folder that has
// them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "codec/files/atomic_file.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/quantise.h"
#include "simplify/clean/verify.h"
#include "simplify/log/write_mesh.h"
#include "simplify/read/read_mesh.h"
#include "tests/support/block_grid.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

/// The figures of a mesh that other tools report.
struct Known {
  const char* name;
  std::size_t tetrahedra, points, boundaryTriangles;
  std::uint64_t repeated, flat, coincident, nonManifoldEdges, nonManifoldVertices;
};
void PrintTo(const Known& known, std::ostream* out) { *out << known.name; }

class RealData : public ::testing::TestWithParam<Known> {};

TEST_P(RealData, isCleanedToWhatIsKnown) {
  const char* folder = std::getenv("QTET_DATA");
  if (!folder) GTEST_SKIP() << "QTET_DATA is not set";
  const Known& known = GetParam();
  const std::filesystem::path path =
      std::filesystem::path(folder) / (std::string(known.name) + ".vtu");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";

  Result<ReadMesh> read = readMesh(path);
  ASSERT_TRUE(read) << read.error().text();
  const Result<CleanReport> report = cleanMesh(read->mesh);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(read->mesh.tetrahedra.size(), known.tetrahedra);
  EXPECT_EQ(read->mesh.points.size(), known.points);
  EXPECT_EQ(report->repeatedVertexCells.count, known.repeated);
  EXPECT_EQ(report->flatCells.count, known.flat);
  EXPECT_EQ(report->invertedCells.count, 0u);
  EXPECT_EQ(report->coincidentPoints.count, known.coincident);
  EXPECT_EQ(report->nonManifoldEdges.count, known.nonManifoldEdges);
  EXPECT_EQ(report->nonManifoldVertices.count, known.nonManifoldVertices);

  const Result<QuantisedMesh> quantised = quantise(read->mesh);
  ASSERT_TRUE(quantised);
  EXPECT_EQ(quantised->mesh.boundary.size(), known.boundaryTriangles);
  EXPECT_EQ(quantised->report.worseCells.count, 0u);
  const Result<OnLattice> put =
      putOnLattice(read->mesh, quantised->mesh.lattice, quantised->mesh.fields);
  ASSERT_TRUE(put) << put.error().text();
  EXPECT_TRUE(sameMesh(quantised->mesh, put->mesh));
}

/// An O-grid of 75 cells round, cut into tetrahedra by parity, whose ends coincide: welded it is a
/// solid torus, as other tools made it.
TEST(RealDataWeld, thePostsSlitClosesToASolidOfGenusOne) {
  const char* folder = std::getenv("QTET_DATA");
  if (!folder) GTEST_SKIP() << "QTET_DATA is not set";
  const std::filesystem::path path = std::filesystem::path(folder) / "post.vtu";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  ReadOptions options;
  options.weld = 0;
  options.fields = std::vector<std::string>{};
  Result<ReadMesh> read = readMesh(path, options);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->report.weldedPoints, 1444u);
  EXPECT_EQ(read->report.mendedFaces, 37u * 37u);
  const Result<CleanReport> report = cleanMesh(read->mesh);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(read->mesh.tetrahedra.size(), 514744u);
  EXPECT_EQ(read->mesh.points.size(), 108300u);
  EXPECT_EQ(report->flatCells.count + report->invertedCells.count + report->coincidentPoints.count,
            0u);
  EXPECT_EQ(report->nonManifoldEdges.count + report->nonManifoldVertices.count, 0u);
  EXPECT_EQ(report->components, 1u);
  const Result<QuantisedMesh> quantised = quantise(read->mesh);
  ASSERT_TRUE(quantised);
  EXPECT_EQ(quantised->mesh.boundary.size(), 22200u);
  // A closed orientable surface of Euler characteristic 0 is a torus.
  EXPECT_EQ(testing::eulerCharacteristics(quantised->mesh), (std::array<std::int64_t, 2>{0, 0}));
}

/// The same on a small scale, and with the flaws that the other meshes have.
TEST(RealDataStandIn, aSlitRingClosesToASolidOfGenusOne) {
  constexpr int kRound = 15, kAcross = 5;
  const auto folder = testing::freshFolder("slit-ring");
  TetMesh ring = testing::slitRing(kRound, kAcross);
  ring.tetrahedra.push_back({1, 1, 2, 21});  // spx has such a cell
  ASSERT_TRUE(writeFileAtomically(folder / "ring.vtu", vtuBytes(ring)));
  ReadOptions options;
  options.weld = 0;
  Result<ReadMesh> read = readMesh(folder / "ring.vtu", options);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->report.weldedPoints, 36u);
  EXPECT_EQ(read->report.mendedFaces, 25u);
  const Result<CleanReport> report = cleanMesh(read->mesh);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->repeatedVertexCells.count, 1u);
  EXPECT_EQ(read->mesh.tetrahedra.size(), 5u * 15 * 25 + 25);
  EXPECT_EQ(read->mesh.points.size(), 15u * 36);
  EXPECT_EQ(report->flatCells.count + report->invertedCells.count + report->coincidentPoints.count,
            0u);
  EXPECT_EQ(report->nonManifoldEdges.count + report->nonManifoldVertices.count, 0u);
  EXPECT_EQ(report->components, 1u);
  const Result<QuantisedMesh> quantised = quantise(read->mesh);
  ASSERT_TRUE(quantised);
  EXPECT_EQ(quantised->report.worseCells.count, 0u);
  EXPECT_EQ(quantised->mesh.boundary.size(), 4u * 5 * 15 * 2);
  EXPECT_EQ(testing::eulerCharacteristics(quantised->mesh), (std::array<std::int64_t, 2>{0, 0}));
  const Result<OnLattice> put =
      putOnLattice(read->mesh, quantised->mesh.lattice, quantised->mesh.fields);
  ASSERT_TRUE(put) << put.error().text();
  EXPECT_TRUE(sameMesh(quantised->mesh, put->mesh));
}

INSTANTIATE_TEST_SUITE_P(Meshes, RealData,
                         ::testing::Values(Known{"spx", 12935, 2896, 2762, 1, 0, 0, 0, 0},
                                           Known{"bluntfin", 187395, 40960, 13516, 0, 77, 39, 0, 0},
                                           Known{"post", 513375, 109744, 27676, 0, 0, 1444, 0, 0},
                                           Known{"comb", 215040, 47025, 15616, 0, 0, 0, 0, 0},
                                           Known{"utahtorso", 51419, 8278, 1500, 0, 0, 0, 21, 38},
                                           Known{"liver", 199010, 37216, 19000, 0, 0, 0, 22, 40},
                                           Known{"wing-potential", 889073, 157263, 59434, 0, 0, 0,
                                                 0, 0}),
                         [](const auto& set) {
                           std::string name = set.param.name;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

}  // namespace
}  // namespace qtet
