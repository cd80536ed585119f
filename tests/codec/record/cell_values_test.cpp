// Cell fields: prediction, the table's association, and what a log may not say about them. Round
// trips are in round_trip_test.cpp.
#include "codec/record/cell_values.h"

#include <gtest/gtest.h>

#include <functional>

#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/log/value_block.h"
#include "codec/refine/refiner.h"
#include "simplify/fuse/qtetfusion.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

std::int64_t predicted(const std::vector<std::int64_t>& values) {
  return CellAncestry::predictFrom(values);
}

TEST(CellAncestry, aValueThatTwoHaveWinsElseTheMean) {
  EXPECT_EQ(predicted({}), 0);
  EXPECT_EQ(predicted({7}), 7);
  EXPECT_EQ(predicted({7, 2}), 4);
  EXPECT_EQ(predicted({-7, 2}), -2);
  EXPECT_EQ(predicted({9, 1, 9}), 9);
  EXPECT_EQ(predicted({9, 1, 9, 1}), 1);
  EXPECT_EQ(predicted({1, 9, 1, 9}), 1);
  EXPECT_EQ(predicted({10, 20, 30, 45}), 26);
}

TEST(CellAncestry, aBaseCellKnowsTheEarlierOnesAcrossItsFaces) {
  CellAncestry ancestry;
  ancestry.addBase(
      std::vector<Tetrahedron>{{0, 1, 2, 3}, {1, 2, 3, 4}, {2, 3, 4, 5}, {6, 7, 8, 9}});
  const std::vector<std::int64_t> values{100, 10, 1, 0};
  const auto at = [&](CellId t) { return values[t]; };
  EXPECT_EQ(ancestry.predict(0, at), 0);
  EXPECT_EQ(ancestry.predict(1, at), 100);
  EXPECT_EQ(ancestry.predict(2, at), 10);
  EXPECT_EQ(ancestry.predict(3, at), 1);  // a part of its own: the cell before it
}

TEST(LogWriter, aCellFieldWithoutAValueForEachTetrahedronIsRefused) {
  LatticeMesh mesh = testing::gridMesh(2, 1);
  testing::addCellFields(mesh);
  FusionHistory history = simplify(mesh, {}).value();
  EXPECT_EQ(history.values[2], mesh.values[2]);  // fusions neither change nor add to them
  EXPECT_TRUE(encodeLog(history, {}));
  history.values[2].pop_back();
  EXPECT_EQ(encodeLog(history, {}).error().code, ErrorCode::kBadValue);
}

class CellFieldLog : public ::testing::Test {
 protected:
  CellFieldLog() {
    LatticeMesh mesh = testing::gridMesh(4, 1);
    testing::addCellFields(mesh);
    LogWriterOptions options;
    options.chunkBytes = 300;
    bytes_ = encodeLog(simplify(mesh, {}).value(), options).value().bytes;
    index_ = LogIndex::parse(bytes_).value();
  }

  std::vector<std::int32_t> values(std::uint32_t chunk, std::uint32_t part) const {
    const BlockEntry& b = index_.block(chunk, part);
    return decodeValueBlock(ByteView(bytes_).subspan(b.offset, b.size), index_.components(part),
                            index_.tuples(chunk, part), index_.blockCodec(chunk, part))
        .value();
  }
  Status apply(Refiner& refiner, std::uint32_t chunk) const {
    const BlockEntry& b = index_.block(chunk, kStructurePart);
    return refiner.apply(chunk, ByteView(bytes_).subspan(b.offset, b.size),
                         values(chunk, kPositionsPart));
  }
  static constexpr std::uint32_t kRegion = 2;
  static constexpr std::uint32_t kRegionPart = kFirstFieldPart + kRegion;

  Bytes bytes_;
  LogIndex index_;
};

TEST_F(CellFieldLog, theTableTellsCellFieldsFromPointFields) {
  ASSERT_EQ(index_.fields.size(), 4u);
  EXPECT_EQ(index_.fields[1].association, Association::kPoint);
  EXPECT_EQ(index_.fields[3].association, Association::kCell);
  EXPECT_EQ(index_.fields[3].components, 2u);
  ASSERT_GT(index_.chunks.size(), 2u);
  for (std::uint32_t chunk = 0; chunk < index_.chunks.size(); ++chunk) {
    EXPECT_EQ(index_.tuples(chunk, kPositionsPart), index_.chunks[chunk].newVertices);
    EXPECT_EQ(index_.tuples(chunk, kFirstFieldPart),
              index_.chunks[chunk].newVertices + index_.chunks[chunk].records);
    EXPECT_EQ(index_.tuples(chunk, kRegionPart), index_.chunks[chunk].newTetrahedra);
  }
}

TEST_F(CellFieldLog, anUnknownAssociationIsRefused) {
  index_.fields[1].association = static_cast<Association>(2);
  const auto index = LogIndex::parse(index_.encode(), index_.encodeLater());
  ASSERT_FALSE(index);
  EXPECT_EQ(index.error().code, ErrorCode::kBadValue);
  EXPECT_NE(index.error().message.find("field 1 "), std::string::npos) << index.error().text();
}

TEST_F(CellFieldLog, theManifestHasTheTablesShapes) {
  const auto manifest = manifestOf(index_);
  ASSERT_TRUE(manifest) << manifest.error().text();
  ASSERT_EQ(manifest->fields.size(), index_.fields.size());
  for (std::size_t f = 0; f < index_.fields.size(); ++f) {
    EXPECT_EQ(manifest->fields[f].association,
              index_.fields[f].association == Association::kCell ? "cell" : "point");
    EXPECT_EQ(manifest->fields[f].components, index_.fields[f].components);
  }
}

TEST_F(CellFieldLog, wrongNumbersOfValuesAreRefusedAndHarmless) {
  for (const int by : {-1, 1}) {
    Refiner refiner(index_);
    ASSERT_TRUE(apply(refiner, 0));
    std::vector<std::int32_t> wrong = values(0, kRegionPart);
    wrong.resize(wrong.size() + static_cast<std::size_t>(by));
    EXPECT_EQ(refiner.applyField(kRegion, 0, wrong).error().code, ErrorCode::kBadValue);
    EXPECT_TRUE(refiner.applyField(kRegion, 0, values(0, kRegionPart)));
  }
}

TEST_F(CellFieldLog, aValueBeyondTheLimitIsRefused) {
  Refiner refiner(index_);
  ASSERT_TRUE(apply(refiner, 0));
  std::vector<std::int32_t> large = values(0, kRegionPart);
  large.back() = (1 << 30) + 1000;
  EXPECT_EQ(refiner.applyField(kRegion, 0, large).error().code, ErrorCode::kBadValue);
  EXPECT_EQ(refiner.applyField(kRegion, 0, values(0, kRegionPart)).error().code,
            ErrorCode::kBadOrder);
}

TEST_F(CellFieldLog, aCellFieldNeverRunsAheadAndKeepsItsOrder) {
  Refiner refiner(index_);
  EXPECT_EQ(refiner.applyField(kRegion, 0, values(0, kRegionPart)).error().code,
            ErrorCode::kBadOrder);
  ASSERT_TRUE(apply(refiner, 0));
  ASSERT_TRUE(apply(refiner, 1));
  EXPECT_EQ(refiner.applyField(kRegion, 1, values(1, kRegionPart)).error().code,
            ErrorCode::kBadOrder);
  ASSERT_TRUE(refiner.applyField(kRegion, 0, values(0, kRegionPart)));
  // what chunk 1 brought has stand-ins
  EXPECT_EQ(refiner.fieldValues(kRegion).size(), refiner.tetrahedra().size());
  ASSERT_TRUE(refiner.applyField(kRegion, 1, values(1, kRegionPart)));
  EXPECT_EQ(refiner.fieldValues(kRegion).size(), refiner.tetrahedra().size());
}

TEST_F(CellFieldLog, labelsCostLittle) {
  std::uint64_t bytes = 0;
  for (std::uint32_t chunk = 0; chunk < index_.chunks.size(); ++chunk)
    bytes += index_.block(chunk, kRegionPart).size;
  std::uint64_t cells = 0;
  for (const ChunkEntry& e : index_.chunks) cells += e.newTetrahedra;
  // Draco's fixed cost for a block of one attribute
  const std::uint64_t fixedBytes = 48 * index_.chunks.size();
  EXPECT_LT(8 * (bytes - std::min(bytes, fixedBytes)), cells / 2)
      << bytes << " bytes for " << cells << " cells";
}

}  // namespace
}  // namespace qtet
