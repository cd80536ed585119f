#include "simplify/blocks/reduce_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "codec/files/file_spool.h"
#include "simplify/mesh/triangle_tree.h"
#include "tests/simplify/blocks/whole_pieces.h"
#include "tests/support/meshes.h"
#include "tests/support/random_solid.h"

namespace qtet {
namespace {

const ReduceOptions kSmall{
    .cells = 1000, .blockCells = 700, .samples = {2000, 500}, .surfaceSamples = 500};

Result<ReducedMesh> reduced(const LatticeMesh& mesh, const FusionOptions& options = {},
                            const ReduceOptions& reduce = kSmall, std::size_t pieces = 1) {
  return testing::reduceWhole(mesh, {}, options, reduce, pieces);
}

Bytes bytesOf(const ReducedMesh& mesh) {
  MeshPiece piece;
  piece.points = mesh.mesh.points;
  piece.values = mesh.mesh.values;
  piece.tetrahedra = mesh.mesh.tetrahedra;
  piece.quadrics = mesh.fusions.quadrics;
  for (const FollowedPlace& place : mesh.samples.places)
    piece.places.push_back({0, place.tetrahedron, static_cast<std::uint16_t>(place.isCovered),
                            static_cast<std::uint16_t>(place.isOriginal)});
  return toBytes(piece);
}

std::vector<TriangleTree::Cell> trianglesOf(const LatticeMesh& mesh) {
  std::vector<TriangleTree::Cell> out;
  for (const Triangle& t : mesh.boundary) out.push_back({t[0], t[1], t[2], kGhost});
  return out;
}

/// How far the farthest vertex of one boundary is from the other boundary.
double farthestVertex(const LatticeMesh& from, const LatticeMesh& to) {
  const std::vector<TriangleTree::Cell> cells = trianglesOf(to);
  std::vector<std::uint32_t> ids(cells.size());
  std::iota(ids.begin(), ids.end(), 0u);
  const TriangleTree tree(to.points, cells, ids);
  double out = 0;
  for (const Triangle& t : from.boundary)
    for (const VertexId v : t) {
      NearestTriangle nearest;
      tree.nearest(toVector(from.points[v]), nearest);
      out = std::max(out, nearest.point.squared);
    }
  return std::sqrt(out);
}

bool holds(const LatticeMesh& mesh, const Tetrahedron& cell, const Vector3& p) {
  const auto at = [&](std::size_t i) { return toVector(mesh.points[cell[i]]); };
  const auto volume = [](const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    return dot(b - a, cross(c - a, d - a));
  };
  const double most = volume(at(0), at(1), at(2), at(3)), least = -1e-6 * most;
  return volume(p, at(1), at(2), at(3)) >= least && volume(at(0), p, at(2), at(3)) >= least &&
         volume(at(0), at(1), p, at(3)) >= least && volume(at(0), at(1), at(2), p) >= least;
}

void expectSound(const LatticeMesh& mesh, const ReducedMesh& out, std::size_t most) {
  EXPECT_LE(out.mesh.tetrahedra.size(), most);
  EXPECT_GT(out.mesh.tetrahedra.size(), most * 9 / 10);
  EXPECT_EQ(testing::whatIsWrongWith(out.mesh), "");
  EXPECT_EQ(testing::eulerCharacteristics(out.mesh), testing::eulerCharacteristics(mesh));
  EXPECT_EQ(out.tetrahedra, mesh.tetrahedra.size());
  for (const FollowedPlace& place : out.samples.places)
    if (place.isCovered)
      ASSERT_TRUE(holds(out.mesh, out.mesh.tetrahedra[place.tetrahedron], place.at));
  EXPECT_LE(farthestVertex(mesh, out.mesh), out.samples.toMesh.max + 1e-9);
  EXPECT_LE(farthestVertex(out.mesh, mesh), out.samples.toOriginal.max + 1e-9);
  EXPECT_LE(out.samples.toOriginal.mean, out.samples.toOriginal.max);
}

TEST(ReduceMesh, blocksLeaveASoundMeshOfSoManyCellsAndKnowHowFarItIs) {
  const LatticeMesh mesh = testing::gridMesh(8, 2);  // 3,072 cells
  const Result<ReducedMesh> out = reduced(mesh);
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_GT(out->bands, 1u);
  expectSound(mesh, *out, 1000);
  EXPECT_GT(out->envelopeTolerance, 0);
  EXPECT_LT(out->envelopeTolerance, kEnvelopeTolerance);
}

TEST(ReduceMesh, tunnelsAndSingularPlacesStay) {
  const LatticeMesh tunnel =
      testing::gridMesh(9, 2, [](int i, int j, int) { return (i - 4) * (i - 4) + j * j > 4; });
  const Result<ReducedMesh> one = reduced(tunnel);
  ASSERT_TRUE(one) << one.error().text();
  expectSound(tunnel, *one, 1000);
  const LatticeMesh pinched =
      testing::gridMesh(8, 3, [](int i, int j, int) { return (i < 4) == (j < 4); });
  const Result<ReducedMesh> two = reduced(pinched);
  ASSERT_TRUE(two) << two.error().text();
  expectSound(pinched, *two, 1000);
}

TEST(ReduceMesh, theResultDependsOnNoThreadsAndNoSpool) {
  const LatticeMesh mesh = testing::gridMesh(7, 4);
  const Result<ReducedMesh> one = reduced(mesh);
  ASSERT_TRUE(one);
  ReduceOptions onDisk = kSmall;
  const auto folder = testing::freshFolder("reduce-spool");
  int spools = 0;
  onDisk.spool = [&] {
    ++spools;
    return fileSpoolBeside(folder / "part.qtet");
  };
  FusionOptions two;
  two.threads = 2;
  const Result<ReducedMesh> other = reduced(mesh, two, onDisk);
  ASSERT_TRUE(other);
  EXPECT_GT(spools, 2);
  EXPECT_EQ(bytesOf(*other), bytesOf(*one));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(ReduceMesh, theResultDependsOnNoPiecesOfTheOriginal) {
  LatticeMesh mesh = testing::gridMesh(7, 4);
  testing::addCellFields(mesh);
  const Result<ReducedMesh> one = reduced(mesh);
  ASSERT_TRUE(one);
  for (const std::size_t pieces : {2, 7}) {
    const Result<ReducedMesh> other = reduced(mesh, {}, kSmall, pieces);
    ASSERT_TRUE(other);
    EXPECT_EQ(bytesOf(*other), bytesOf(*one)) << pieces;
    EXPECT_EQ(other->samples.truth, one->samples.truth);
    EXPECT_EQ(other->samples.surface, one->samples.surface);
  }
}

TEST(ReduceMesh, cellFieldsRegionsAndMissingValuesComeThrough) {
  LatticeMesh mesh = testing::gridMesh(8, 2);
  testing::addCellFields(mesh);
  std::vector<std::vector<std::uint8_t>> missing(mesh.fields.size());
  missing[0].resize(mesh.values[0].size(), 0);
  for (VertexId v = 0; v < mesh.points.size(); ++v)
    missing[0][v] = mesh.points[v][0] < mesh.points[mesh.points.size() / 2][0];
  FusionOptions options;
  options.regionField = 2;
  options.cost.labels = {{2, 1}};
  const Result<ReducedMesh> out = testing::reduceWhole(mesh, missing, options, kSmall);
  ASSERT_TRUE(out) << out.error().text();
  EXPECT_EQ(testing::whatIsWrongWith(out->mesh), "");
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const std::size_t elements =
        isCellField(mesh.fields[f]) ? out->mesh.tetrahedra.size() : out->mesh.points.size();
    EXPECT_EQ(out->mesh.values[f].size(), mesh.fields[f].components * elements);
  }
  EXPECT_EQ(out->missing[0].size(), out->mesh.points.size());
  EXPECT_GT(std::ranges::count(out->missing[0], 1), 0);
  EXPECT_GT(std::ranges::count(out->missing[0], 0), 0);
}

TEST(ReduceMesh, aMeshWithoutFieldsHasTheQuadricsOfPlanes) {
  LatticeMesh mesh = testing::gridMesh(8, 2);
  mesh.fields.clear(), mesh.values.clear();
  const Result<ReducedMesh> out = reduced(mesh);
  ASSERT_TRUE(out) << out.error().text();
  expectSound(mesh, *out, 1000);
}

TEST(ReduceMesh, randomSolidsStaySound) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    const LatticeMesh mesh = testing::randomSolid(seed).mesh;
    ReduceOptions options = kSmall;
    options.cells = mesh.tetrahedra.size() / 2;
    options.blockCells = mesh.tetrahedra.size() / 3 + 1;
    const Result<ReducedMesh> out = reduced(mesh, {}, options);
    if (!out) {
      EXPECT_EQ(out.error().code, ErrorCode::kLimitExceeded) << out.error().text();
      continue;
    }
    EXPECT_EQ(testing::whatIsWrongWith(out->mesh), "") << seed;
    EXPECT_EQ(testing::eulerCharacteristics(out->mesh), testing::eulerCharacteristics(mesh));
  }
}

TEST(ReduceMesh, saysHowManyCellsItCannotDoWithout) {
  ReduceOptions options = kSmall;
  options.cells = 1;
  const LatticeMesh pinched =
      testing::gridMesh(4, 3, [](int i, int j, int) { return (i < 2) == (j < 2); });
  const Result<ReducedMesh> out = reduced(pinched, {}, options);
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, ErrorCode::kLimitExceeded);
  EXPECT_NE(out.error().message.find("cannot be reduced to 1 cells"), std::string::npos);
}

TEST(ReduceMesh, aStopAndAFullDiskAreErrors) {
  std::stop_source stop;
  FusionOptions options;
  options.stop = stop.get_token();
  ReduceOptions reduce = kSmall;
  reduce.progress = [&](double) { stop.request_stop(); };
  const Result<ReducedMesh> stopped = reduced(testing::gridMesh(8, 2), options, reduce);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);

  class FullSpool final : public ByteSpool {
   public:
    explicit FullSpool(int puts) : puts_(puts) {}
    Status append(ByteView) override {
      return --puts_ < 0 ? Status(fail(ErrorCode::kIo, "the disk is full")) : Status{};
    }
    [[nodiscard]] std::uint64_t size() const override { return 0; }
    [[nodiscard]] Status read(std::uint64_t, std::span<std::uint8_t>) const override {
      return fail(ErrorCode::kIo, "cannot read");
    }
    [[nodiscard]] Status writeTo(const ByteSink&) const override { return {}; }

   private:
    int puts_;
  };
  for (const int puts : {0, 2, 100}) {
    ReduceOptions full = kSmall;
    full.spool = [puts]() -> Result<std::unique_ptr<ByteSpool>> {
      return std::make_unique<FullSpool>(puts);
    };
    const Result<ReducedMesh> out = reduced(testing::gridMesh(8, 2), {}, full);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().code, ErrorCode::kIo);
  }
}

}  // namespace
}  // namespace qtet
