// A ball in eight pieces: each is encoded and decoded for itself, with frozen seams, and together
// they are the ball.
#include "codec/refine/patch_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "codec/log/level_runs.h"
#include "codec/log/log_writer.h"
#include "codec/log/record_writer.h"
#include "codec/log/value_block.h"
#include "codec/mesh/boundary.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

constexpr int kCubes = 10, kPieces = 8;

bool isInBall(int i, int j, int k) {
  const auto square = [](int a) { return (2 * a + 1 - kCubes) * (2 * a + 1 - kCubes); };
  return square(i) + square(j) + square(k) < kCubes * kCubes;
}

/// The piece of each tetrahedron: its octant round the middle of the lattice's box.
std::vector<int> piecesOf(const LatticeMesh& mesh) {
  LatticePoint least = mesh.points[0], most = least;
  for (const LatticePoint& p : mesh.points)
    for (std::size_t a = 0; a < 3; ++a)
      least[a] = std::min(least[a], p[a]), most[a] = std::max(most[a], p[a]);
  std::vector<int> out;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    int piece = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      std::int64_t sum = 0;
      for (const VertexId v : t) sum += mesh.points[v][a];
      piece |= (sum > std::int64_t{2} * (least[a] + most[a])) << a;
    }
    out.push_back(piece);
  }
  return out;
}

/// The vertices of more than one piece.
std::vector<VertexId> seamsOf(const LatticeMesh& mesh, const std::vector<int>& pieces) {
  std::vector<std::set<int>> around(mesh.points.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const VertexId v : mesh.tetrahedra[t]) around[v].insert(pieces[t]);
  std::vector<VertexId> out;
  for (VertexId v = 0; v < around.size(); ++v)
    if (around[v].size() > 1) out.push_back(v);
  return out;
}

/// The part of a history that one piece has, and its coarse part.
struct Piece {
  FusionHistory history;
  CoarsePart coarse;
  std::vector<std::uint32_t> cells;  // of the history, one a tetrahedron of the coarse part
  std::vector<VertexId> vertices;    // the same of its points
};

Piece pieceOf(const FusionHistory& whole, const std::vector<int>& pieceOfCell, int piece,
              const std::vector<VertexId>& seams) {
  Piece out;
  FusionHistory& h = out.history;
  h.lattice = whole.lattice, h.points = whole.points;
  std::vector<std::uint32_t> cellOf(whole.cells.size());
  for (std::uint32_t c = 0; c < whole.cells.size(); ++c) {
    if (pieceOfCell[c] != piece) continue;
    cellOf[c] = static_cast<std::uint32_t>(h.cells.size());
    h.cells.push_back(whole.cells[c]), h.live.push_back(whole.live[c]);
  }
  std::map<std::uint32_t, std::uint32_t> levels;
  const auto isOurs = [&](const Fusion& f) {
    return pieceOfCell[whole.deletedCells[f.firstDeleted]] == piece;
  };
  for (const Fusion& f : whole.fusions)
    if (isOurs(f)) levels.emplace(f.level, 0);
  for (auto& [level, number] : levels) number = h.levels++;
  for (Fusion f : whole.fusions) {
    if (!isOurs(f)) continue;
    const Fusion from = f;
    f.level = levels[from.level];
    f.firstAffected = h.affectedCells.size(), f.firstDeleted = h.deletedCells.size();
    for (std::uint64_t i = 0; i < from.affectedCount; ++i) {
      EXPECT_EQ(pieceOfCell[whole.affectedCells[from.firstAffected + i]], piece);
      h.affectedCells.push_back(cellOf[whole.affectedCells[from.firstAffected + i]]);
      h.affectedLabels.push_back(whole.affectedLabels[from.firstAffected + i]);
    }
    for (std::uint64_t i = 0; i < from.deletedCount; ++i)
      h.deletedCells.push_back(cellOf[whole.deletedCells[from.firstDeleted + i]]);
    h.fusions.push_back(f);
  }
  std::map<VertexId, VertexId> slots;
  for (std::uint32_t c = 0; c < h.cells.size(); ++c)
    for (const VertexId v : h.cells[c])
      if (h.live[c] && v != kGhost) slots.emplace(v, 0);
  for (auto& [vertex, slot] : slots) {
    slot = static_cast<VertexId>(out.vertices.size());
    out.vertices.push_back(vertex);
    out.coarse.points.push_back(h.points[vertex]);
    if (std::ranges::binary_search(seams, vertex)) out.coarse.frozen.push_back(slot);
  }
  for (std::uint32_t c = 0; c < h.cells.size(); ++c) {
    if (!h.live[c]) continue;
    const auto ghost =
        static_cast<std::size_t>(std::ranges::find(h.cells[c], kGhost) - h.cells[c].begin());
    if (ghost == 4) {
      Tetrahedron t{};
      for (std::size_t i = 0; i < 4; ++i) t[i] = slots[h.cells[c][i]];
      out.coarse.tetrahedra.push_back(t);
      out.cells.push_back(c);
    } else {
      const auto turned = withLast(h.cells[c], ghost);
      out.coarse.boundary.push_back({slots[turned[0]], slots[turned[1]], slots[turned[2]]});
    }
  }
  return out;
}

/// A patch as it is kept: what to begin with, rows and blocks.
struct Patch {
  CoarsePart coarse;
  std::vector<ChunkEntry> rows;
  Bytes body;
};

Patch encoded(const Piece& piece) {
  Patch out{piece.coarse, {}, {}};
  RecordWriter writer(piece.history, CodecId::kDraco, {});
  LogWriterOptions options;
  options.chunkBytes = 30;
  EXPECT_TRUE(writer.patch(piece.coarse, piece.cells, piece.vertices));
  const Status written = writeLevelRuns(writer, piece.history.levels, options);
  EXPECT_TRUE(written) << written.error().text();
  EXPECT_TRUE(writer.closeChunk(piece.history.levels, kLevelEnd));
  for (const Bytes& blocks : writer.chunks().geometry())
    out.body.insert(out.body.end(), blocks.begin(), blocks.end());
  out.rows = std::move(writer.chunks().rows());
  return out;
}

/// Decodes all blocks but the first, which is empty: its reader has the coarse part.
void decode(const Patch& patch, PatchDecoder& decoder) {
  decoder.start(patch.coarse);
  std::size_t at = 0;
  Slots end = decoder.mesh().next();
  std::uint64_t records = 0;
  for (std::uint32_t i = 0; i < patch.rows.size(); ++i) {
    const ChunkEntry& row = patch.rows[i];
    const ByteView structure = ByteView(patch.body).subspan(at, row.blocks[kStructurePart].size);
    at += structure.size();
    const ByteView positions = ByteView(patch.body).subspan(at, row.blocks[kPositionsPart].size);
    at += positions.size();
    if (i == 0) continue;
    const auto given = decodeValueBlock(positions, 3, row.newVertices, row.valueCodec);
    ASSERT_TRUE(given) << given.error().text();
    Values values(*given);
    end = {end.vertices + row.newVertices, end.tetrahedra + row.newTetrahedra,
           end.triangles + row.newBoundaryTriangles};
    records += row.records;
    decoder.records().meter().grant(structure.size());
    PatchBlock block{i, row, RangeDecoder(structure), values, end, records};
    const Result<Extent> extent = decoder.read(block);
    ASSERT_TRUE(extent) << extent.error().text();
    ASSERT_TRUE(decoder.records().checkCounts(block));
  }
}

using Corners = std::array<LatticePoint, 4>;

/// A cell by its points, turned so that the same cell is the same in every mesh.
Corners cornersOf(const std::vector<LatticePoint>& points, const Tetrahedron& t) {
  Corners best{points[t[0]], points[t[1]], points[t[2]], points[t[3]]};
  Tetrahedron order{0, 1, 2, 3};
  const Corners given = best;
  while (std::ranges::next_permutation(order).found) {
    int swaps = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) swaps += order[j] > order[i];
    if (swaps % 2 != 0) continue;
    best =
        std::min(best, Corners{given[order[0]], given[order[1]], given[order[2]], given[order[3]]});
  }
  return best;
}

TEST(PatchDecoder, aBallInEightPiecesWithFrozenSeamsIsTheBall) {
  LatticeMesh ball = testing::gridMesh(kCubes, 4, isInBall);
  ball.fields.clear(), ball.values.clear();
  const std::vector<int> pieces = piecesOf(ball);
  const std::vector<VertexId> seams = seamsOf(ball, pieces);
  FusionOptions options;
  options.targetRatio = 0;
  options.kept = seams;
  const FusionHistory history = simplify(ball, options).value();
  ASSERT_GT(history.fusions.size(), ball.points.size() / 4);

  std::map<std::array<VertexId, 3>, int> pieceOfFace;
  for (std::size_t t = 0; t < ball.tetrahedra.size(); ++t)
    for (int i = 0; i < 4; ++i)
      pieceOfFace[sortedFace(cellFace(ball.tetrahedra[t], i))] = pieces[t];
  std::vector<int> pieceOfCell = pieces;  // the history's cells: tetrahedra, then ghosts
  for (const Triangle& t : ball.boundary) pieceOfCell.push_back(pieceOfFace.at(sortedFace(t)));

  std::vector<LatticePoint> points;  // of the union: the seams' vertices once, and all others
  std::map<VertexId, VertexId> seamSlots;
  std::multiset<Corners> cells;
  std::size_t triangles = 0, blocks = 0;
  for (int piece = 0; piece < kPieces; ++piece) {
    const Piece part = pieceOf(history, pieceOfCell, piece, seams);
    ASSERT_FALSE(part.coarse.frozen.empty());
    const Patch patch = encoded(part);
    blocks += patch.rows.size() - 1;
    PatchRequests requests;
    PatchDecoder decoder({history.lattice.bits, false, false}, requests);
    ASSERT_NO_FATAL_FAILURE(decode(patch, decoder));
    EXPECT_EQ(decoder.level(), part.history.levels);
    const GrowingMesh& mesh = decoder.mesh();
    std::vector<VertexId> identity(mesh.points.size(), kGhost);
    for (const VertexId v : patch.coarse.frozen) {
      const auto at = seamSlots.emplace(part.vertices[v], points.size());
      if (at.second) points.push_back(mesh.points[v]);
      identity[v] = at.first->second;
      EXPECT_EQ(mesh.points[v], points[identity[v]]);
      EXPECT_FALSE(mesh.maysplit(v));
    }
    for (VertexId v = 0; v < identity.size(); ++v)
      if (identity[v] == kGhost)
        identity[v] = static_cast<VertexId>(points.size()), points.push_back(mesh.points[v]);
    for (const Tetrahedron& t : mesh.tetrahedra)
      cells.insert(
          cornersOf(points, {identity[t[0]], identity[t[1]], identity[t[2]], identity[t[3]]}));
    triangles += mesh.boundary.size();
  }
  EXPECT_GT(blocks, std::size_t{4} * kPieces) << "too few for a test of blocks";
  EXPECT_EQ(points.size(), ball.points.size());
  EXPECT_EQ(triangles, ball.boundary.size());
  std::multiset<Corners> expected;
  for (const Tetrahedron& t : ball.tetrahedra) expected.insert(cornersOf(ball.points, t));
  EXPECT_EQ(cells, expected);
}

}  // namespace
}  // namespace qtet
