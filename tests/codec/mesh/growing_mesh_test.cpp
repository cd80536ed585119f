// Compares the mesh that grows in place with one that is rebuilt after every split of a real log.
#include "codec/mesh/growing_mesh.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <vector>

#include "codec/log/log_index.h"
#include "codec/log/log_writer.h"
#include "codec/log/value_block.h"
#include "codec/mesh/boundary.h"
#include "codec/record/record_coder.h"
#include "codec/refine/refiner.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

constexpr int kSpreadBits = 20;

/// A log, decoded by a GrowingMesh in the test's hands; the refiner says what has to come out.
class Replay {
 public:
  /// The lattice is made 2^finer times as fine.
  Replay(LatticeMesh mesh, int finer) {
    mesh.lattice.bits += finer;
    for (LatticePoint& p : mesh.points)
      for (std::int32_t& x : p) x <<= finer;
    bytes_ = encodeLog(simplify(mesh, {}).value(), {}).value().bytes;
    index_ = LogIndex::parse(bytes_).value();
    refiner.emplace(index_);
    applyNext();
    growing.points.assign(refiner->points().begin(), refiner->points().end());
    growing.tetrahedra.assign(refiner->tetrahedra().begin(), refiner->tetrahedra().end());
    growing.boundary.assign(refiner->boundary().begin(), refiner->boundary().end());
    growing.start(index_.positionBits);
  }

  [[nodiscard]] int bits() const { return index_.positionBits; }

  /// `entered(v)` between enter and apply, `applied(v)` after it.
  template <class Entered, class Applied>
  void run(const Entered& entered, const Applied& applied) {
    for (std::uint32_t chunk = 1; chunk < index_.chunks.size(); ++chunk) {
      const std::vector<std::int32_t> given = positions(chunk);
      Values values(given);
      RangeDecoder decoder(block(chunk, kStructurePart));
      RecordCoder<RangeDecoder> coder(decoder, models_, growing, link, values);
      const ChunkEntry& e = index_.chunks[chunk];
      for (level = e.firstLevel; level <= e.lastLevel; ++level) {
        ASSERT_EQ(e.endSlot, kLevelEnd) << "chunks of whole levels are what this test can follow";
        growing.beginLevel(level);
        for (VertexId v = 0; v < growing.levelVertices(); ++v) {
          if (!growing.maysplit(v) || !coder.splits(v, level, false)) continue;
          ASSERT_TRUE(growing.enter(v, link));
          Split split;
          ASSERT_TRUE(coder.code(v, {}, split));
          entered(v);
          firstNew = static_cast<VertexId>(growing.points.size());
          growing.apply(v, link, split);
          applied(v);
          ++splits;
          if (::testing::Test::HasFatalFailure()) return;
        }
      }
      applyNext();
    }
  }

  GrowingMesh growing;
  Link link;
  std::optional<Refiner> refiner;
  std::uint32_t level = 0;
  VertexId firstNew = 0;  // of the split in hand
  std::size_t splits = 0;

 private:
  [[nodiscard]] ByteView block(std::uint32_t chunk, std::uint32_t part) const {
    const BlockEntry& b = index_.block(chunk, part);
    return ByteView(bytes_).subspan(static_cast<std::size_t>(b.offset), b.size);
  }
  [[nodiscard]] std::vector<std::int32_t> positions(std::uint32_t chunk) const {
    return decodeValueBlock(block(chunk, kPositionsPart), 3, index_.tuples(chunk, kPositionsPart),
                            CodecId::kDraco)
        .value();
  }
  void applyNext() {
    const std::uint32_t chunk = refiner->chunksApplied();
    const Status status = refiner->apply(chunk, block(chunk, kStructurePart), positions(chunk));
    ASSERT_TRUE(status) << status.error().text();
  }

  Bytes bytes_;
  LogIndex index_;
  RecordModels models_;
};

std::vector<std::vector<CellRef>> builtStars(const GrowingMesh& mesh) {
  std::vector<std::vector<CellRef>> stars(mesh.points.size());
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const VertexId v : mesh.tetrahedra[t]) stars[v].push_back(t);
  for (std::uint32_t t = 0; t < mesh.boundary.size(); ++t)
    for (const VertexId v : mesh.boundary[t]) stars[v].push_back(t | kBoundaryBit);
  return stars;
}

GrowingMesh::Spread summedSpread(const GrowingMesh& mesh, VertexId v, std::span<const CellRef> star,
                                 int shift) {
  GrowingMesh::Spread out;
  for (const CellRef ref : star)
    for (const VertexId w : mesh.cell(ref)) {
      if (w == kGhost || w == v) continue;
      ++out.edges;
      for (std::size_t a = 0; a < 3; ++a) {
        const std::int64_t d = (mesh.points[v][a] - mesh.points[w][a]) >> shift;
        out.squares[a] += static_cast<std::uint64_t>(d * d);
      }
    }
  return out;
}

void expectAsBuiltAnew(Replay& replay) {
  const auto check = [&](VertexId) {
    const auto stars = builtStars(replay.growing);
    for (VertexId v = 0; v < stars.size(); ++v) {
      ASSERT_TRUE(std::ranges::equal(replay.growing.star(v), stars[v]))
          << "vertex " << v << " after " << replay.splits << " splits";
      ASSERT_EQ(replay.growing.spread(v),
                summedSpread(replay.growing, v, stars[v], replay.growing.spreadShift()))
          << "vertex " << v;
    }
  };
  check(0);
  replay.run([](VertexId) {}, check);
  EXPECT_GT(replay.splits, 30u);
}

TEST(GrowingMesh, starsAndSpreadsAreThoseOfAMeshBuiltAnewAfterEverySplit) {
  Replay replay(testing::gridMesh(4, 1), 0);
  expectAsBuiltAnew(replay);
  EXPECT_EQ(replay.growing.spreadShift(), 0);
  EXPECT_TRUE(std::ranges::equal(replay.growing.points, replay.refiner->points()));
  EXPECT_TRUE(std::ranges::equal(replay.growing.tetrahedra, replay.refiner->tetrahedra()));
  EXPECT_TRUE(std::ranges::equal(replay.growing.boundary, replay.refiner->boundary()));
}

TEST(GrowingMesh, acrossAFaceLiesTheOtherCellThatHasIt) {
  Replay replay(testing::gridMesh(4, 1), 0);
  const GrowingMesh& mesh = replay.growing;
  replay.run([](VertexId) {}, [](VertexId) {});
  std::map<Triangle, std::vector<CellRef>> cellsOf;  // by the face's corners, ascending
  const auto faceOf = [&](CellRef cell, std::size_t corner) {
    const auto last = withLast(mesh.tetrahedra[cell], corner);
    Triangle face{last[0], last[1], last[2]};
    std::ranges::sort(face);
    return face;
  };
  for (CellRef cell = 0; cell < mesh.tetrahedra.size(); ++cell)
    for (std::size_t corner = 0; corner < 4; ++corner)
      cellsOf[faceOf(cell, corner)].push_back(cell);
  std::size_t open = 0;
  for (CellRef cell = 0; cell < mesh.tetrahedra.size(); ++cell)
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::vector<CellRef>& its = cellsOf[faceOf(cell, corner)];
      const auto other = mesh.across(cell, corner);
      open += !other;
      ASSERT_EQ(other.has_value(), its.size() == 2) << "cell " << cell << ", corner " << corner;
      if (other) ASSERT_EQ(*other, its[0] == cell ? its[1] : its[0]);
    }
  EXPECT_EQ(open, mesh.boundary.size());
}

TEST(GrowingMesh, spreadsOfAFineLatticeAreMeasuredInCoarserSteps) {
  const LatticeMesh mesh =
      testing::gridMesh(3, 2, [](int i, int j, int) { return i != 1 || j != 1; });
  Replay replay(mesh, 26 - mesh.lattice.bits);
  ASSERT_EQ(replay.bits(), 26);
  EXPECT_EQ(replay.growing.spreadShift(), 26 - kSpreadBits);
  expectAsBuiltAnew(replay);
}

TEST(GrowingMesh, aSplitKeepsItsStarFromSplittingInTheSameLevel) {
  Replay replay(testing::gridMesh(3, 3), 0);
  std::uint32_t before = 0;
  replay.run(
      [&](VertexId v) {
        EXPECT_FALSE(replay.growing.maysplit(v));
        for (const VertexId w : replay.link.vertices())
          if (w != kGhost) {
            EXPECT_FALSE(replay.growing.maysplit(w));
          }
        if (replay.level == before) return;
        before = replay.level;
        std::size_t free = 0;
        for (VertexId w = 0; w < replay.growing.levelVertices(); ++w)
          free += replay.growing.maysplit(w);
        EXPECT_EQ(free, replay.growing.levelVertices() - replay.link.vertices().size() +
                            replay.link.hasGhost() - 1)
            << "a level's first split takes its star alone";
      },
      [&](VertexId v) {
        EXPECT_EQ(replay.growing.born(v), replay.level);
        for (VertexId w = replay.firstNew; w < replay.growing.points.size(); ++w) {
          EXPECT_EQ(replay.growing.born(w), replay.level);
          EXPECT_FALSE(replay.growing.maysplit(w));
        }
      });
  EXPECT_GT(replay.splits, 10u);
}

// A vertex whose star grows again and again leaves its old places in the pool behind, until the
// pool is made compact.
TEST(GrowingMesh, aHubThatGrowsForLongKeepsItsStar) {
  // Tetrahedra in a ring round the edge 0-1; vertex 2 on the ring is split into two neighbours
  // along it, over and over.
  constexpr VertexId kFirst = 3;
  GrowingMesh mesh;
  mesh.points = {{500, 500, 0},   {500, 500, 1000}, {900, 500, 500},
                 {500, 900, 500}, {100, 500, 500},  {500, 100, 500}};
  mesh.tetrahedra = {{0, 2, kFirst, 1}, {0, kFirst, 4, 1}, {0, 4, 5, 1}, {0, 5, 2, 1}};
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  mesh.start(10);
  Link link;
  for (std::uint32_t level = 1; level <= 400; ++level) {
    mesh.beginLevel(level);
    ASSERT_TRUE(mesh.enter(2, link));
    // The two tetrahedra at 2 part: what holds vertex 5 stays with 2, what holds the other
    // neighbour goes to the new vertex.
    Split split;
    split.points = {mesh.points[2], mesh.points[2]};
    const std::uint32_t top = link.localOf(1), bottom = link.localOf(0), kept = link.localOf(5);
    for (std::uint32_t f = 0; f < link.triangles().size(); ++f)
      link.label(f, std::ranges::find(link.triangles()[f].vertex, kept) ==
                        link.triangles()[f].vertex.end());
    const LocalVertex v = kPreyBit, w = kPreyBit | 1, ghost = link.localOf(kGhost);
    split.deleted = {{bottom, v, w, top}, {bottom, w, v, ghost}, {v, w, top, ghost}};
    mesh.apply(2, link, split);
    const auto stars = builtStars(mesh);
    for (VertexId u = 0; u < stars.size(); ++u)
      ASSERT_TRUE(std::ranges::equal(mesh.star(u), stars[u]))
          << "vertex " << u << ", level " << level;
  }
  EXPECT_EQ(mesh.star(0).size(), 2 * 404u);
}

TEST(GrowingMesh, aVertexBetweenTwoSpheresIsNotEntered) {
  GrowingMesh mesh;
  mesh.points.resize(7, LatticePoint{1, 2, 3});
  mesh.tetrahedra = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  mesh.start(10);
  mesh.beginLevel(1);
  Link link;
  EXPECT_FALSE(mesh.enter(0, link));
  EXPECT_TRUE(mesh.enter(1, link));
}

}  // namespace
}  // namespace qtet
