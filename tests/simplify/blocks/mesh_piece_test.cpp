#include "simplify/blocks/mesh_piece.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "simplify/blocks/block_planes.h"
#include "simplify/blocks/piece_store.h"
#include "simplify/blocks/shared_vertices.h"
#include "simplify/mesh/split_mix64.h"
#include "tests/simplify/blocks/pieces.h"

namespace qtet {
namespace {

using testing::pieceWithAll;
using testing::shapeOf;

/// By the whole's numbers: a cell with its values, a triangle, a place.
using Cells = std::map<std::array<WholeVertex, 4>, std::vector<std::int32_t>>;

Cells cellsOf(const MeshPiece& piece, const PieceShape& shape) {
  Cells out;
  for (std::size_t c = 0; c < piece.tetrahedra.size(); ++c) {
    std::array<WholeVertex, 4> key{};
    for (std::size_t i = 0; i < 4; ++i) key[i] = piece.vertices[piece.tetrahedra[c][i]];
    std::vector<std::int32_t>& values = out[key];
    for (std::size_t f = 0; f < shape.fields.size(); ++f)
      for (std::size_t k = 0; k < shape.fields[f].components; ++k)
        if (isCellField(shape.fields[f]))
          values.push_back(piece.values[f][c * shape.fields[f].components + k]);
  }
  return out;
}

std::vector<std::uint32_t> randomBlocks(std::size_t cells, std::uint32_t blocks) {
  SplitMix64 random(3);
  std::vector<std::uint32_t> out;
  for (std::size_t c = 0; c < cells; ++c)
    out.push_back(static_cast<std::uint32_t>(random.next() % blocks));
  return out;
}

TEST(MeshPiece, itsBytesGiveItBackAndNoneOfThemMayChange) {
  const MeshPiece piece = pieceWithAll(2);
  const Bytes bytes = toBytes(piece);
  const Result<MeshPiece> back = pieceFrom(bytes);
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(toBytes(*back), bytes);
  EXPECT_EQ(back->vertices, piece.vertices);
  EXPECT_EQ(back->quadrics, piece.quadrics);
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_FALSE(pieceFrom(ByteView(bytes).first(size))) << size;
  for (std::size_t at = 0; at < bytes.size(); at += 5) {
    Bytes broken = bytes;
    broken[at] ^= 0x10;
    const Result<MeshPiece> none = pieceFrom(broken);
    ASSERT_FALSE(none) << at;
    EXPECT_EQ(none.error().code, ErrorCode::kBadChecksum);
  }
}

TEST(MeshPiece, dealtAndJoinedItIsTheSame) {
  const MeshPiece piece = pieceWithAll(4);
  const PieceShape shape = shapeOf(piece);
  const auto blockOf = randomBlocks(piece.tetrahedra.size(), 5);
  std::vector<MeshPiece> dealtPieces;
  const auto several =
      deal(piece, shape, blockOf, 6, [&](std::uint32_t block, MeshPiece&& own) -> Status {
        EXPECT_EQ(own.tetrahedra.size(),
                  static_cast<std::size_t>(std::ranges::count(blockOf, block)));
        for (const PieceTriangle& t : own.boundary)
          for (const VertexId v : t.corners)
            EXPECT_NE(std::ranges::find(own.tetrahedra[t.tetrahedron], v),
                      own.tetrahedra[t.tetrahedron].end());
        dealtPieces.push_back(std::move(own));
        return {};
      });
  ASSERT_TRUE(several);
  EXPECT_EQ(dealtPieces.size(), 5u) << "block 5 has no cells";
  const MeshPiece back = joined(dealtPieces, shape);
  EXPECT_EQ(back.vertices, piece.vertices);
  EXPECT_EQ(back.points, piece.points);
  EXPECT_EQ(back.quadrics, piece.quadrics) << "sums of whole numbers";
  EXPECT_EQ(back.values[0], piece.values[0]);
  EXPECT_EQ(back.missing[0], piece.missing[0]);
  EXPECT_EQ(cellsOf(back, shape), cellsOf(piece, shape));
  EXPECT_EQ(back.boundary.size(), piece.boundary.size());
  ASSERT_EQ(back.places.size(), piece.places.size());
  for (const PiecePlace& place : back.places)
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(back.vertices[back.tetrahedra[place.tetrahedron][i]],
                piece.vertices[piece.tetrahedra[piece.places[place.number].tetrahedron][i]]);
}

TEST(MeshPiece, cellsOfNoBlockAreLeftOutAndTheirVerticesAreShared) {
  const MeshPiece piece = pieceWithAll(2);
  std::vector<std::uint32_t> blockOf(piece.tetrahedra.size(), kNoBlock);
  blockOf[7] = 0;
  MeshPiece own;
  const auto several =
      deal(piece, shapeOf(piece), blockOf, 1, [&](std::uint32_t, MeshPiece&& given) -> Status {
        own = std::move(given);
        return {};
      });
  ASSERT_TRUE(several);
  EXPECT_EQ(own.tetrahedra.size(), 1u);
  EXPECT_EQ(*several, own.vertices);
}

TEST(MeshPiece, anErrorOfTheTakerIsHandedOn) {
  const MeshPiece piece = pieceWithAll(1);
  const std::vector<std::uint32_t> blockOf(piece.tetrahedra.size(), 0);
  const auto out = deal(piece, shapeOf(piece), blockOf, 1, [](std::uint32_t, MeshPiece&&) {
    return Status(fail(ErrorCode::kIo, "full"));
  });
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, ErrorCode::kIo);
}

TEST(BlockPlanes, blocksAreAboutEqualForAnyOrderOfTheSample) {
  SplitMix64 random(5);
  std::vector<CellMiddle> sample;
  for (int i = 0; i < 7000; ++i) {
    CellMiddle& m = sample.emplace_back();
    for (std::uint32_t& x : m) x = static_cast<std::uint32_t>(random.next() % 4000);
  }
  const BlockPlanes planes(sample, 7);
  EXPECT_EQ(planes.count(), 7u);
  std::vector<int> cells(7, 0);
  for (const CellMiddle& m : sample) ++cells[planes.blockOf(m)];
  for (const int count : cells) EXPECT_NEAR(count, 1000, 30);
  std::vector<CellMiddle> turned(sample.rbegin(), sample.rend());
  const BlockPlanes same(turned, 7);
  for (const CellMiddle& m : sample) ASSERT_EQ(same.blockOf(m), planes.blockOf(m));
}

TEST(BlockPlanes, cellsOfOnePlaceAreOneBlock) {
  EXPECT_EQ(BlockPlanes(std::vector<CellMiddle>(10, {3, 3, 3}), 4).count(), 1u);
  EXPECT_EQ(BlockPlanes({}, 4).count(), 1u);
  EXPECT_EQ(BlockPlanes({{0, 0, 0}, {9, 0, 0}}, 2).count(), 2u);
}

TEST(SharedVertices, areThoseOfSeveralBlocks) {
  SharedVertices shared;
  const std::vector<WholeVertex> mayBe{1, 2, 3, 4};
  shared.add(0, std::vector<WholeVertex>{0, 1, 2}, mayBe);
  shared.add(2, std::vector<WholeVertex>{0, 2, 4}, mayBe);
  shared.add(2, std::vector<WholeVertex>{3, 4}, mayBe);  // of another source, the same block
  const auto of = shared.take(3);
  EXPECT_EQ(of[0], (std::vector<WholeVertex>{2}));
  EXPECT_TRUE(of[1].empty());
  EXPECT_EQ(of[2], (std::vector<WholeVertex>{2}));
}

TEST(PieceStore, givesTheBlocksPiecesByTheirSource) {
  PieceStore store(std::make_unique<MemorySpool>());
  const MeshPiece one = pieceWithAll(1), two = pieceWithAll(2);
  ASSERT_TRUE(store.put(1, 9, two));
  ASSERT_TRUE(store.put(1, 4, one));
  ASSERT_TRUE(store.put(0, 4, two));
  const auto pieces = store.get(1);
  ASSERT_TRUE(pieces);
  ASSERT_EQ(pieces->size(), 2u);
  EXPECT_EQ((*pieces)[0].tetrahedra.size(), one.tetrahedra.size());
  EXPECT_EQ((*pieces)[1].tetrahedra.size(), two.tetrahedra.size());
  EXPECT_TRUE(store.get(5)->empty());
  EXPECT_EQ(store.sizeBytes(), toBytes(one).size() + 2 * toBytes(two).size());
}

TEST(NewVertex, isBehindTheInputsAndEachIsAnother) {
  EXPECT_GT(newVertex(0, 0, 0), WholeVertex{~std::uint32_t{0}});
  EXPECT_LT(newVertex(0, 0, ~0u), newVertex(0, 1, 0));
  EXPECT_LT(newVertex(0, (1u << 25) - 1, ~0u), newVertex(1, 0, 0));
  EXPECT_LT(newVertex(1, 0, 5), newVertex(1, 0, 6));
}

}  // namespace
}  // namespace qtet
