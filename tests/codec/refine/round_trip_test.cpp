// The promise of the whole: what was fused is refined back, to the bit, at every prefix of the log.
#include <gtest/gtest.h>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/log/value_block.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "simplify/clean/verify.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::eulerCharacteristics;
using testing::gridMesh;
using testing::meshOfHistory;
using testing::whatIsWrongWith;

bool everything(int, int, int) { return true; }
bool withoutTunnel(int i, int j, int) { return i != 2 || j != 2; }
bool withoutVoid(int i, int j, int k) { return i != 2 || j != 2 || k != 2; }
bool twoParts(int i, int, int) { return i != 2; }
bool twoCubesAtAnEdge(int i, int j, int) { return (i < 2) == (j < 2); }
bool twoCubesAtACorner(int i, int j, int k) {
  return (i < 2 && j < 2 && k < 2) || (i >= 2 && j >= 2 && k >= 2);
}

struct Shape {
  const char* name;
  bool (*keep)(int, int, int);
  std::uint32_t seed;
};
void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }

class RoundTrip : public ::testing::TestWithParam<Shape> {
 protected:
  void SetUp() override {
    mesh_ = gridMesh(5, GetParam().seed, GetParam().keep);
    testing::addCellFields(mesh_);
    FusionOptions options;
    options.targetRatio = 0;
    auto history = simplify(mesh_, options);
    ASSERT_TRUE(history) << history.error().text();
    history_ = std::move(*history);
    LogWriterOptions writer;
    writer.chunkBytes = 160;  // many chunks, most of which end inside a level
    auto log = encodeLog(history_, writer);
    ASSERT_TRUE(log) << log.error().text();
    bytes_ = std::move(log->bytes);
    auto index = LogIndex::parse(bytes_);
    ASSERT_TRUE(index) << index.error().text();
    index_ = std::move(*index);
  }

  ByteView block(std::uint32_t chunk, std::uint32_t part) const {
    const BlockEntry& b = index_.block(chunk, part);
    return ByteView(bytes_).subspan(b.offset, b.size);
  }

  std::vector<std::int32_t> values(std::uint32_t chunk, std::uint32_t part) const {
    auto v = decodeValueBlock(block(chunk, part), index_.components(part),
                              index_.tuples(chunk, part), index_.blockCodec(chunk, part));
    EXPECT_TRUE(v) << v.error().text();
    return *v;
  }

  Status apply(Refiner& refiner, std::uint32_t chunk) const {
    if (Status s =
            refiner.apply(chunk, block(chunk, kStructurePart), values(chunk, kPositionsPart));
        !s)
      return s;
    for (std::uint32_t f = 0; f < index_.fields.size(); ++f)
      if (Status s = applyField(refiner, chunk, f); !s) return s;
    return {};
  }

  Status applyField(Refiner& refiner, std::uint32_t chunk, std::uint32_t field) const {
    const std::uint32_t part = kFirstFieldPart + field;
    return index_.blockCodec(chunk, part) == CodecId::kLifted
               ? refiner.applyField(field, chunk, block(chunk, part))
               : refiner.applyField(field, chunk, values(chunk, part));
  }

  LatticeMesh meshOf(const Refiner& refiner) const {
    LatticeMesh out;
    out.lattice = mesh_.lattice;
    out.fields = mesh_.fields;
    out.points.assign(refiner.points().begin(), refiner.points().end());
    out.tetrahedra.assign(refiner.tetrahedra().begin(), refiner.tetrahedra().end());
    out.boundary.assign(refiner.boundary().begin(), refiner.boundary().end());
    for (std::uint32_t f = 0; f < mesh_.fields.size(); ++f)
      out.values.emplace_back(refiner.fieldValues(f).begin(), refiner.fieldValues(f).end());
    return out;
  }

  LatticeMesh mesh_;
  FusionHistory history_;
  Bytes bytes_;
  LogIndex index_;
};

TEST_P(RoundTrip, everyLevelIsTheMeshThatTheSimplifierHad) {
  EXPECT_GT(history_.levels, 5u);
  for (std::uint32_t level = 0; level <= history_.levels; ++level) {
    Refiner refiner(index_);
    refiner.stopAtLevel(level);
    for (std::uint32_t chunk = 0;
         chunk < index_.chunks.size() && (chunk == 0 || refiner.level() < level); ++chunk) {
      const Status s = apply(refiner, chunk);
      ASSERT_TRUE(s) << s.error().text();
    }
    ASSERT_EQ(refiner.level(), level);
    const auto same = sameMesh(meshOf(refiner), meshOfHistory(history_, level));
    EXPECT_TRUE(same) << "level " << level << ": " << same.error().text();
  }
}

TEST_P(RoundTrip, everyPrefixThatEndsAtAChunkIsAMeshOfTheSameTopology) {
  EXPECT_GT(index_.chunks.size(), 6u);
  const auto chi = eulerCharacteristics(mesh_);
  Refiner refiner(index_);
  for (std::uint32_t chunk = 0; chunk < index_.chunks.size(); ++chunk) {
    const Status s = apply(refiner, chunk);
    ASSERT_TRUE(s) << s.error().text();
    const LatticeMesh now = meshOf(refiner);
    ASSERT_EQ(whatIsWrongWith(now), "") << "after chunk " << chunk;
    EXPECT_EQ(eulerCharacteristics(now), chi) << "after chunk " << chunk;
  }
  const auto same = sameMesh(meshOf(refiner), mesh_);
  EXPECT_TRUE(same) << same.error().text();
}

TEST_P(RoundTrip, aFieldThatComesLateEndsTheSame) {
  for (std::uint32_t field = 1; field < index_.fields.size(); ++field) {
    Refiner steady(index_);
    Refiner late(index_);
    for (std::uint32_t chunk = 0; chunk < index_.chunks.size(); ++chunk) {
      ASSERT_TRUE(apply(steady, chunk));
      ASSERT_TRUE(late.apply(chunk, block(chunk, kStructurePart), values(chunk, kPositionsPart)));
      if (chunk == 2) {
        ASSERT_TRUE(applyField(late, 0, field));
      }
      if (chunk >= 2) {
        ASSERT_EQ(late.fieldValues(field).size(), steady.fieldValues(field).size());
      }
    }
    for (std::uint32_t chunk = 1; chunk < index_.chunks.size(); ++chunk)
      ASSERT_TRUE(applyField(late, chunk, field));
    EXPECT_TRUE(std::ranges::equal(late.fieldValues(field), steady.fieldValues(field)))
        << "field " << field;
    EXPECT_EQ(late.digest(), steady.digest());
  }
}

TEST_P(RoundTrip, aCellHasItsValueFromTheFirstPrefixThatHoldsIt) {
  Refiner whole(index_);
  for (std::uint32_t chunk = 0; chunk < index_.chunks.size(); ++chunk)
    ASSERT_TRUE(apply(whole, chunk));
  Refiner refiner(index_);
  for (std::uint32_t chunk = 0; chunk < index_.chunks.size(); ++chunk) {
    ASSERT_TRUE(apply(refiner, chunk));
    for (std::uint32_t f = 2; f < index_.fields.size(); ++f) {
      const auto now = refiner.fieldValues(f);
      ASSERT_EQ(now.size(), refiner.tetrahedra().size() * index_.fields[f].components);
      ASSERT_TRUE(std::ranges::equal(now, whole.fieldValues(f).first(now.size())))
          << "field " << f << " after chunk " << chunk;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, RoundTrip,
    ::testing::Values(Shape{"solid", everything, 1}, Shape{"solidAgain", everything, 2},
                      Shape{"tunnel", withoutTunnel, 3}, Shape{"void", withoutVoid, 4},
                      Shape{"twoParts", twoParts, 5}, Shape{"pinchedEdge", twoCubesAtAnEdge, 6},
                      Shape{"pinchedCorner", twoCubesAtACorner, 7}),
    [](const auto& shape) { return std::string(shape.param.name); });

TEST(LogWriter, aMeshThatIsNotSimplifiedIsOneChunk) {
  FusionOptions options;
  options.targetRatio = 1;
  const LatticeMesh mesh = gridMesh(3, 9);
  const auto history = simplify(mesh, options);
  ASSERT_TRUE(history);
  EXPECT_EQ(history->levels, 0u);
  const auto log = encodeLog(*history, {});
  ASSERT_TRUE(log) << log.error().text();
  EXPECT_EQ(log->statistics.chunks, 1u);
}

TEST(LogWriter, theManifestListsWhatTheRefinerReaches) {
  const auto history = simplify(gridMesh(5, 1), {});
  ASSERT_TRUE(history);
  LogWriterOptions options;
  options.chunkBytes = 400;
  const auto log = encodeLog(*history, options);
  ASSERT_TRUE(log);
  const auto index = LogIndex::parse(log->bytes);
  ASSERT_TRUE(index);
  const auto manifest = manifestOf(*index);
  ASSERT_TRUE(manifest) << manifest.error().text();
  ASSERT_EQ(manifest->levels.size(), history->levels + 1u);
  Refiner refiner(*index);
  for (std::uint32_t chunk = 0; chunk < index->chunks.size(); ++chunk) {
    const auto block = [&](std::uint32_t part) {
      return ByteView(log->bytes)
          .subspan(index->block(chunk, part).offset, index->block(chunk, part).size);
    };
    ASSERT_TRUE(refiner.apply(
        chunk, block(0),
        *decodeValueBlock(block(1), 3, index->tuples(chunk, kPositionsPart), CodecId::kDraco)));
    const ManifestLevel& level = manifest->levels[refiner.level()];
    EXPECT_LE(level.chunk, chunk);
    if (refiner.level() == index->chunks[chunk].lastLevel) {
      EXPECT_EQ(level.chunk, chunk);
    }
  }
  ASSERT_EQ(refiner.levelCounts().size(), manifest->levels.size());
  for (std::size_t i = 0; i < manifest->levels.size(); ++i) {
    EXPECT_EQ(manifest->levels[i].tetrahedra, refiner.levelCounts()[i].tetrahedra);
    EXPECT_EQ(manifest->levels[i].vertices, refiner.levelCounts()[i].vertices);
    EXPECT_EQ(manifest->levels[i].boundaryTriangles, refiner.levelCounts()[i].boundaryTriangles);
  }
}

}  // namespace
}  // namespace qtet
