// The layout `regions`: packets in any order that their dependencies allow are meshes on the way
// and one and the same mesh in the end.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <random>

#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/log/value_block.h"
#include "codec/mesh/compact_mesh.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "simplify/clean/verify.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"
#include "tests/support/random_solid.h"
#include "tests/support/solid_check.h"

namespace qtet {
namespace {

using testing::checkSolid;
using testing::eulerCharacteristics;
using testing::gridMesh;
using testing::meshOfHistory;
using testing::whatIsWrongWith;

FusionHistory historyOf(const LatticeMesh& mesh, std::size_t cellsPerPacket) {
  FusionOptions options;
  options.targetRatio = 0;
  options.bands.cellsPerPacket = cellsPerPacket;
  options.bands.dearest = 1;
  auto history = simplify(mesh, options);
  EXPECT_TRUE(history) << history.error().text();
  return std::move(*history);
}

LogFile logOf(const FusionHistory& history) {
  LogWriterOptions options;
  options.chunkBytes = 600;
  auto log = encodeLog(history, options);
  EXPECT_TRUE(log) << log.error().text();
  auto file = LogFile::fromBytes(std::move(log->bytes));
  EXPECT_TRUE(file) << file.error().text();
  return std::move(*file);
}

LatticeMesh meshOf(const Refiner& refiner, const LatticeMesh& original) {
  LatticeMesh out;
  out.lattice = original.lattice;
  out.fields = original.fields;
  out.points.assign(refiner.points().begin(), refiner.points().end());
  out.tetrahedra.assign(refiner.tetrahedra().begin(), refiner.tetrahedra().end());
  out.boundary.assign(refiner.boundary().begin(), refiner.boundary().end());
  for (std::uint32_t f = 0; f < original.fields.size(); ++f)
    out.values.emplace_back(refiner.fieldValues(f).begin(), refiner.fieldValues(f).end());
  dropHoles(out);
  return out;
}

std::vector<std::uint32_t> allFields(const LogFile& log) {
  std::vector<std::uint32_t> fields(log.index().fields.size());
  std::iota(fields.begin(), fields.end(), 0u);
  return fields;
}

std::vector<std::uint32_t> fileOrder(const LogIndex& index) {
  std::vector<std::uint32_t> order(index.chunks.size());
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

/// Every chunk once, each after the one that it depends on.
std::vector<std::uint32_t> randomOrder(const LogIndex& index, std::mt19937& random) {
  std::vector<std::uint32_t> ready{0}, order;
  while (!ready.empty()) {
    std::swap(ready[random() % ready.size()], ready.back());
    const std::uint32_t chunk = ready.back();
    ready.pop_back();
    order.push_back(chunk);
    for (std::uint32_t i = 1; i < index.chunks.size(); ++i)
      if (index.dependencies[index.chunks[i].firstDependency] == chunk) ready.push_back(i);
  }
  return order;
}

Refiner refined(const LogFile& log, const std::vector<std::uint32_t>& order) {
  Refiner refiner(log.index());
  for (const std::uint32_t chunk : order)
    if (const Status s = applyChunk(log, refiner, chunk, allFields(log)); !s)
      ADD_FAILURE() << s.error().text();
  return refiner;
}

/// Digest of the mesh, then the values of every field.
std::vector<std::int32_t> outcome(const Refiner& refiner) {
  std::vector<std::int32_t> out;
  for (const std::uint8_t byte : refiner.digest()) out.push_back(byte);
  for (std::uint32_t f = 0; f < refiner.index().fields.size(); ++f)
    out.insert(out.end(), refiner.fieldValues(f).begin(), refiner.fieldValues(f).end());
  return out;
}

bool everything(int, int, int) { return true; }
bool withoutTunnel(int i, int j, int) { return i != 3 || j != 3; }
bool twoCubesAtAnEdge(int i, int j, int) { return (i < 4) == (j < 4); }

struct Shape {
  const char* name;
  bool (*keep)(int, int, int);
};
void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }

class Regions : public ::testing::TestWithParam<Shape> {
 protected:
  void SetUp() override {
    mesh_ = gridMesh(8, 7, GetParam().keep);
    testing::addCellFields(mesh_);
    history_ = historyOf(mesh_, 250);
    log_.emplace(logOf(history_));
  }
  [[nodiscard]] const LogIndex& index() const { return log_->index(); }

  LatticeMesh mesh_;
  FusionHistory history_;
  std::optional<LogFile> log_;
};

TEST_P(Regions, aLogHasAHeadAndBandsOfPackets) {
  ASSERT_EQ(index().layout, Layout::kRegions);
  EXPECT_GE(index().lastDepth(), 3u);
  EXPECT_LT(index().firstDepth(), index().lastDepth());
  EXPECT_GT(index().headChunks(), 1u);
  EXPECT_EQ(index().chunks.size(),
            index().headChunks() + (2u << index().lastDepth()) - (1u << index().firstDepth()));
  std::uint32_t records = 0;
  for (const ChunkEntry& e : index().chunks) records += e.node != 0 ? e.records : 0;
  EXPECT_GT(records, history_.fusions.size() / 4) << "the bands did little";
}

TEST_P(Regions, everyLevelIsTheMeshThatTheSimplifierHad) {
  const auto manifest = manifestOf(index());
  ASSERT_TRUE(manifest);
  EXPECT_EQ(manifest->layout, "regions");
  ASSERT_EQ(manifest->levels.size(), history_.levels + 1u);
  for (std::uint32_t level = 0; level <= history_.levels; ++level) {
    const auto mesh = meshAtLevel(*log_, level);
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_EQ(mesh->tetrahedra.size(), manifest->levels[level].tetrahedra);
    EXPECT_EQ(mesh->points.size(), manifest->levels[level].vertices);
    EXPECT_EQ(mesh->boundary.size(), manifest->levels[level].boundaryTriangles);
    const auto same = sameMesh(*mesh, meshOfHistory(history_, level));
    ASSERT_TRUE(same) << "level " << level << ": " << same.error().text();
  }
}

TEST_P(Regions, anyOrderGivesMeshesOnTheWayAndTheSameSlotsInTheEnd) {
  const auto expected = outcome(refined(*log_, fileOrder(index())));
  const auto chi = eulerCharacteristics(mesh_);
  std::mt19937 random(1);
  for (int trial = 0; trial < 3; ++trial) {
    Refiner refiner(index());
    for (const std::uint32_t chunk : randomOrder(index(), random)) {
      const Status s = applyChunk(*log_, refiner, chunk, allFields(*log_));
      ASSERT_TRUE(s) << s.error().text();
      EXPECT_TRUE(refiner.applied(chunk));
      const LatticeMesh now = meshOf(refiner, mesh_);
      ASSERT_EQ(whatIsWrongWith(now), "") << "after chunk " << chunk;
      ASSERT_EQ(eulerCharacteristics(now), chi) << "after chunk " << chunk;
    }
    EXPECT_EQ(outcome(refiner), expected);
    EXPECT_EQ(refiner.level(), history_.levels);
    const auto same = sameMesh(meshOf(refiner, mesh_), mesh_);
    EXPECT_TRUE(same) << same.error().text();
  }
}

TEST_P(Regions, fieldsThatLagBehindInAnOrderOfTheirOwnEndTheSame) {
  const auto expected = outcome(refined(*log_, fileOrder(index())));
  std::mt19937 random(2);
  for (int trial = 0; trial < 4; ++trial) {
    Refiner refiner(index());
    for (const std::uint32_t chunk : randomOrder(index(), random))
      ASSERT_TRUE(applyChunk(*log_, refiner, chunk, {}));
    for (const std::uint32_t field : allFields(*log_))
      for (const std::uint32_t chunk : randomOrder(index(), random)) {
        ASSERT_TRUE(applyFieldBlock(*log_, refiner, chunk, field));
        EXPECT_TRUE(refiner.fieldApplied(field, chunk));
      }
    EXPECT_EQ(outcome(refiner), expected);
  }
}

// Checks the check itself. The planted decoder carries state from one packet to the next in order
// of arrival, as a coder's models might. It is right in file order, and the check catches it in any
// other.
TEST_P(Regions, aPlantedDependenceOnTheOrderOfArrivalIsCaught) {
  const auto planted = [&](const std::vector<std::uint32_t>& order) {
    Refiner refiner(index());
    for (std::uint32_t arrival = 0; arrival < order.size(); ++arrival) {
      const std::uint32_t chunk = order[arrival];
      EXPECT_TRUE(applyChunk(*log_, refiner, chunk, {}));
      auto values =
          decodeValueBlock(log_->block(chunk, kFirstFieldPart), index().components(kFirstFieldPart),
                           index().tuples(chunk, kFirstFieldPart));
      EXPECT_TRUE(values);
      if (!values->empty())
        values->front() += static_cast<std::int32_t>(arrival) - static_cast<std::int32_t>(chunk);
      EXPECT_TRUE(refiner.applyField(0, chunk, *values));
    }
    const auto field = refiner.fieldValues(0);
    return std::vector(field.begin(), field.end());
  };
  const auto expected = planted(fileOrder(index()));
  const Refiner right = refined(*log_, fileOrder(index()));
  EXPECT_TRUE(std::ranges::equal(expected, right.fieldValues(0)));
  std::mt19937 random(6);
  for (int trial = 0; trial < 4; ++trial)
    EXPECT_NE(planted(randomOrder(index(), random)), expected);
}

TEST_P(Regions, aChunkWaitsForItsParentAndComesOnce) {
  const std::uint32_t last = static_cast<std::uint32_t>(index().chunks.size()) - 1;
  const auto codeOf = [](const Status& s) {
    return s ? std::nullopt : std::optional(s.error().code);
  };
  Refiner refiner(index());
  EXPECT_EQ(codeOf(applyChunk(*log_, refiner, last, {})), ErrorCode::kBadOrder);
  for (std::uint32_t chunk = 0; chunk < index().headChunks(); ++chunk)
    ASSERT_TRUE(applyChunk(*log_, refiner, chunk, {}));
  EXPECT_EQ(codeOf(applyChunk(*log_, refiner, last, {})), ErrorCode::kBadOrder);
  const std::uint32_t first = index().headChunks();
  ASSERT_TRUE(applyChunk(*log_, refiner, first + 1, {}));
  EXPECT_EQ(codeOf(applyChunk(*log_, refiner, first + 1, {})), ErrorCode::kBadOrder);
  EXPECT_FALSE(refiner.applied(first));
  EXPECT_EQ(codeOf(applyFieldBlock(*log_, refiner, first, 0)), ErrorCode::kBadOrder);
  EXPECT_EQ(codeOf(applyFieldBlock(*log_, refiner, first + 1, 0)), ErrorCode::kBadOrder)
      << "the field's own chunks before it are missing";
  ASSERT_TRUE(applyChunk(*log_, refiner, first, {}));
}

TEST_P(Regions, holesAreWhatTheContractSays) {
  Refiner refiner(index());
  for (std::uint32_t chunk = 0; chunk < index().headChunks(); ++chunk)
    ASSERT_TRUE(applyChunk(*log_, refiner, chunk, allFields(*log_)));
  const std::uint32_t first = index().headChunks();
  ASSERT_TRUE(applyChunk(*log_, refiner, first + 1, allFields(*log_)));
  const Slots hole = refiner.firstSlots(first), end = refiner.firstSlots(first + 1);
  ASSERT_LT(hole.tetrahedra, end.tetrahedra);
  for (std::uint32_t v = hole.vertices; v < end.vertices; ++v)
    EXPECT_EQ(refiner.points()[v], kHolePoint);
  for (std::uint32_t t = hole.tetrahedra; t < end.tetrahedra; ++t)
    EXPECT_EQ(refiner.tetrahedra()[t], kHoleTetrahedron);
  for (std::uint32_t t = hole.triangles; t < end.triangles; ++t)
    EXPECT_EQ(refiner.boundary()[t], kHoleTriangle);
  EXPECT_EQ(refiner.points().size(), refiner.firstSlots(first + 2).vertices);
  for (std::uint32_t f = 0; f < index().fields.size(); ++f) {
    const bool cells = index().fields[f].association == Association::kCell;
    EXPECT_EQ(refiner.fieldValues(f).size(),
              (cells ? refiner.tetrahedra().size() : refiner.points().size()) *
                  index().fields[f].components);
  }
}

// By position: a cell's corners in ascending order.
using Corners = std::array<LatticePoint, 4>;
std::vector<Corners> cornersOf(const LatticeMesh& mesh) {
  std::vector<Corners> out;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    out.push_back({mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]});
    std::ranges::sort(out.back());
  }
  std::ranges::sort(out);
  return out;
}

bool meet(const PacketBox& a, const PacketBox& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (a.least[k] > b.most[k] || b.least[k] > a.most[k]) return false;
  return true;
}

/// The chunks that bring every cell that meets the box to full resolution: the head, and packets
/// whose boxes meet it. The chunk table suffices to find them.
std::vector<std::uint32_t> chunksOfBox(const LogIndex& index, const PacketBox& box) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < index.chunks.size(); ++i)
    if (index.chunks[i].node == 0 || meet(index.chunks[i].box, box)) out.push_back(i);
  return out;
}

TEST_P(Regions, aBoxIsAtFullResolutionWithTheChunksThatItNeeds) {
  std::size_t fewest = index().chunks.size();
  for (const std::uint8_t corner : {std::uint8_t{0}, std::uint8_t{100}, std::uint8_t{220}}) {
    const PacketBox box{
        {corner, corner, corner},
        {static_cast<std::uint8_t>(corner + 35), static_cast<std::uint8_t>(corner + 35),
         static_cast<std::uint8_t>(corner + 35)}};
    const std::vector<std::uint32_t> chunks = chunksOfBox(index(), box);
    fewest = std::min(fewest, chunks.size());
    const Refiner refiner = refined(*log_, chunks);  // ascending and closed: every one is accepted
    const LatticeMesh now = meshOf(refiner, mesh_);
    ASSERT_EQ(whatIsWrongWith(now), "");
    const std::vector<Corners> have = cornersOf(now);
    for (const Corners& cell : cornersOf(mesh_)) {
      bool meets = true;
      for (std::size_t a = 0; a < 3; ++a) {
        std::int64_t least = cell[0][a], most = cell[0][a];
        for (const LatticePoint& p : cell)
          least = std::min<std::int64_t>(least, p[a]), most = std::max<std::int64_t>(most, p[a]);
        meets &= (most << 8 >> mesh_.lattice.bits) >= box.least[a] &&
                 (least << 8 >> mesh_.lattice.bits) <= box.most[a];
      }
      if (meets) {
        ASSERT_TRUE(std::ranges::binary_search(have, cell))
            << "a cell in the box is not the original's";
      }
    }
  }
  EXPECT_LT(fewest, index().chunks.size() * 2 / 3);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Regions,
                         ::testing::Values(Shape{"everything", everything},
                                           Shape{"withoutTunnel", withoutTunnel},
                                           Shape{"twoCubesAtAnEdge", twoCubesAtAnEdge}),
                         [](const auto& shape) { return shape.param.name; });

TEST(RegionsHistory, fusionsThatReachBeyondANodeAreRefused) {
  const LatticeMesh mesh = gridMesh(7, 3);
  const FusionHistory honest = historyOf(mesh, 250);
  LogWriterOptions options;
  ASSERT_TRUE(encodeLog(honest, options));
  const Fusion& first = honest.fusions.front();
  for (const std::uint32_t cell :
       {honest.affectedCells[first.firstAffected], honest.deletedCells[first.firstDeleted]}) {
    FusionHistory history = honest;
    history.bands.leaf[cell] ^= 1u << (history.bands.depth - 1);  // across the root's plane
    const auto log = encodeLog(history, options);
    ASSERT_FALSE(log);
    EXPECT_EQ(log.error().code, ErrorCode::kBadValue) << log.error().text();
  }
  FusionHistory history = honest;
  history.bands.leaf.pop_back();
  EXPECT_FALSE(encodeLog(history, options));
}

TEST(RegionsOfRandomSolids, areSolidsAfterEveryChunkInEveryOrder) {
  std::size_t withPackets = 0;
  for (std::uint32_t seed = 0; seed < 16; ++seed) {
    const auto solid = testing::randomSolid(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + solid.description);
    const FusionHistory history = historyOf(solid.mesh, 100);
    if (history.bands.ends.empty()) continue;
    ++withPackets;
    const LogFile log = logOf(history);
    const auto expected = outcome(refined(log, fileOrder(log.index())));
    const auto original = checkSolid(solid.mesh);
    std::mt19937 random(seed);
    Refiner refiner(log.index());
    for (const std::uint32_t chunk : randomOrder(log.index(), random)) {
      ASSERT_TRUE(applyChunk(log, refiner, chunk, allFields(log)));
      const auto now = checkSolid(meshOf(refiner, solid.mesh));
      ASSERT_EQ(now.faults(), "");
      ASSERT_EQ(topologyChange(now, original), "");
    }
    EXPECT_EQ(outcome(refiner), expected);
    const auto same = sameMesh(meshOf(refiner, solid.mesh), solid.mesh);
    EXPECT_TRUE(same) << same.error().text();
  }
  EXPECT_GT(withPackets, 4u);
}

}  // namespace
}  // namespace qtet
