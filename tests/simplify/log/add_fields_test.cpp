// Fields that come to a log later: the geometry stays, the values come back, and a mesh that is not
// the log's is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "codec/log/field_blocks.h"
#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "simplify/clean/verify.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/log/add_fields.h"
#include "simplify/log/match_mesh.h"
#include "simplify/mesh/history_levels.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

/// A grid's mesh, and a log of it in many small chunks. The log carries the first `fields` of the
/// mesh's.
struct Sample {
  LatticeMesh mesh;
  FusionHistory history;
  Bytes bytes;

  explicit Sample(std::uint32_t seed, std::size_t fields, bool measured = false,
                  CodecId codec = CodecId::kDraco)
      : mesh(testing::gridMesh(5, seed)) {
    testing::addCellFields(mesh);
    LatticeMesh carried = mesh;
    carried.fields.resize(fields);
    carried.values.resize(fields);
    history = simplify(std::move(carried), {}).value();
    LogWriterOptions writer;
    writer.chunkBytes = 200;
    writer.valueCodec = codec;
    if (measured) writer.errors = measureLevels(history, {}).value();
    bytes = encodeLog(history, writer).value().bytes;
  }
  [[nodiscard]] LogFile log() const { return LogFile::fromBytes(bytes).value(); }
};

/// The mesh in floats with its fields from `firstField` on; points and cells shuffled, the vertices
/// of cells in any order.
TetMesh shuffled(const LatticeMesh& mesh, std::size_t firstField, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> points(mesh.points.size()), cells(mesh.tetrahedra.size()),
      places(points.size());
  std::iota(points.begin(), points.end(), 0u);
  std::iota(cells.begin(), cells.end(), 0u);
  std::ranges::shuffle(points, random);
  std::ranges::shuffle(cells, random);
  TetMesh out;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    places[points[i]] = i, out.points.push_back(mesh.lattice.position(mesh.points[points[i]]));
  for (const std::uint32_t t : cells) {
    Tetrahedron cell = mesh.tetrahedra[t];
    for (VertexId& v : cell) v = places[v];
    std::ranges::shuffle(cell, random);
    out.tetrahedra.push_back(cell);
  }
  for (std::size_t f = firstField; f < mesh.fields.size(); ++f) {
    const FieldInfo& info = mesh.fields[f];
    MeshField& field = out.fields.emplace_back(
        MeshField{info.name, info.components, "int32", {}, info.association});
    for (const std::uint32_t i : isCellField(info) ? cells : points)
      for (std::size_t c = 0; c < info.components; ++c)
        field.values.push_back(mesh.values[f][i * info.components + c]);
  }
  return out;
}

std::vector<std::uint32_t> allFields(const LogFile& log) {
  std::vector<std::uint32_t> out(log.index().fields.size());
  std::iota(out.begin(), out.end(), 0u);
  return out;
}

Bytes withAdded(const LogFile& log, const TetMesh& mesh) {
  const auto added = addFields(log, mesh);
  EXPECT_TRUE(added) << added.error().text();
  const auto edited = withFields(log, allFields(log), added->fields);
  EXPECT_TRUE(edited) << edited.error().text();
  return edited->together();
}

TEST(LogHistory, holdsEveryLevelOfTheLog) {
  const Sample sample(1, 0);
  const LogFile log = sample.log();
  auto decoded = historyOf(log);
  ASSERT_TRUE(decoded) << decoded.error().text();
  for (std::uint32_t undone = 0; undone <= sample.history.levels; ++undone) {
    LatticeMesh expected = meshAtLevel(log, undone).value();
    const auto same = sameMesh(testing::meshOfHistory(decoded->history, undone), expected);
    ASSERT_TRUE(same) << "level " << undone << ": " << same.error().text();
  }
}

TEST(LogHistory, hasTheValuesOfALogWhoseLastChunkBringsNone) {
  LatticeMesh mesh = testing::gridMesh(3, 1);
  mesh.fields.pop_back(), mesh.values.pop_back();
  testing::addCellFields(mesh);
  const FusionHistory made = simplify(mesh, {}).value();
  const auto inChunksOf = [&](std::uint32_t bytes) {
    LogWriterOptions options;
    options.chunkBytes = bytes;
    return LogFile::fromBytes(encodeLog(made, options).value().bytes).value();
  };
  std::uint32_t bytes = 20;
  while (bytes < 200 && inChunksOf(bytes).chunks().back().records > 0) ++bytes;
  const LogFile file = inChunksOf(bytes);
  ASSERT_EQ(file.chunks().back().records, 0u);
  const LogHistory history = historyOf(file).value();
  const auto values = historyValues(file, history, 0);
  ASSERT_TRUE(values) << values.error().text();
  const LatticeMesh last = meshAtLevel(file, made.levels).value();
  EXPECT_TRUE(std::equal(last.values[0].begin(), last.values[0].end(), values->begin()));
}

TEST(LogHistory, isWrittenAsALogOfTheSameLevelsAgain) {
  const Sample sample(2, 0);
  const LogFile log = sample.log();
  const auto decoded = historyOf(log);
  ASSERT_TRUE(decoded);
  const auto again = encodeLog(decoded->history, {});
  ASSERT_TRUE(again) << again.error().text();
  const LogFile second = LogFile::fromBytes(again->bytes).value();
  for (std::uint32_t level = 0; level <= sample.history.levels; ++level)
    EXPECT_TRUE(sameMesh(meshAtLevel(log, level).value(), meshAtLevel(second, level).value()))
        << level;
}

class AddFields : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(AddFields, theLastLevelHasThemAndTheGeometryStaysByteForByte) {
  const Sample sample(GetParam(), 1, false, GetParam() == 3 ? CodecId::kAdaptive : CodecId::kDraco);
  const LogFile before = sample.log();
  const LogFile after =
      LogFile::fromBytes(withAdded(before, shuffled(sample.mesh, 1, GetParam()))).value();
  ASSERT_TRUE(after.verifyChecksums());
  ASSERT_EQ(after.index().fields.size(), sample.mesh.fields.size());
  for (std::uint32_t chunk = 0; chunk < before.index().chunks.size(); ++chunk)
    for (std::uint32_t part = 0; part < before.index().parts(); ++part)
      ASSERT_TRUE(std::ranges::equal(before.block(chunk, part), after.block(chunk, part)))
          << chunk << " " << part;

  const std::uint32_t last = sample.history.levels;
  LatticeMesh decoded = meshAtLevel(after, last).value();
  // the scale of integers: their own minimum
  for (std::size_t f = 1; f < decoded.fields.size(); ++f)
    for (std::size_t i = 0; i < decoded.values[f].size(); ++i)
      decoded.values[f][i] +=
          static_cast<std::int32_t>(decoded.fields[f].minimum[i % decoded.fields[f].components]);
  const auto same = sameMesh(decoded, sample.mesh);
  EXPECT_TRUE(same) << same.error().text();
  for (std::uint32_t level = 0; level <= last; level += 3)
    EXPECT_TRUE(sameMesh(meshAtLevel(after, level, std::vector<std::uint32_t>{0}).value(),
                         meshAtLevel(before, level).value()))
        << level;
}

// Where the field is a plane, every fused vertex lies on it: the best value has no error.
TEST_P(AddFields, fusedValuesOfAPlaneLieOnIt) {
  const Sample sample(GetParam(), 0);
  const LogHistory decoded = historyOf(sample.log()).value();
  const FusionHistory& history = decoded.history;
  const auto plane = [&](std::size_t v, std::size_t c) {
    const LatticePoint& p = history.points[v];
    return c == 0 ? 3 * p[0] - 2 * p[1] + p[2] + 7 : p[2] - p[0];
  };
  std::vector<std::int32_t> values;
  for (std::size_t v = 0; v < decoded.vertices; ++v)
    for (std::size_t c = 0; c < 2; ++c) values.push_back(plane(v, c));
  const LatticeMesh last = meshAtLevel(sample.log(), history.levels).value();
  const std::vector<std::int32_t> all = fusedValues(decoded, last.tetrahedra, values, 2);
  ASSERT_EQ(all.size(), 2 * history.points.size());
  EXPECT_TRUE(std::equal(values.begin(), values.end(), all.begin()));
  for (std::size_t v = decoded.vertices; v < history.points.size(); ++v)
    for (std::size_t c = 0; c < 2; ++c) ASSERT_EQ(all[2 * v + c], plane(v, c)) << v;
}

TEST_P(AddFields, fusedValuesStayInTheRangeOfTheLastLevels) {
  const Sample sample(GetParam(), 0);
  const LogHistory decoded = historyOf(sample.log()).value();
  std::mt19937 random(GetParam());
  std::vector<std::int32_t> values;
  for (std::size_t i = 0; i < decoded.vertices; ++i) values.push_back(random() % 2 == 0 ? 0 : 4095);
  const LatticeMesh last = meshAtLevel(sample.log(), decoded.history.levels).value();
  for (const std::int32_t value : fusedValues(decoded, last.tetrahedra, values, 1))
    ASSERT_TRUE(0 <= value && value <= 4095) << value;
}

INSTANTIATE_TEST_SUITE_P(Seeds, AddFields, ::testing::Values(1u, 2u, 3u));

TEST(AddFields, errorsAreMeasuredWhereTheLogKnowsThemAndAbsentElsewhere) {
  for (const bool measured : {false, true}) {
    const Sample sample(4, 1, measured);
    const LogFile log = sample.log();
    const LogFile after = LogFile::fromBytes(withAdded(log, shuffled(sample.mesh, 1, 4))).value();
    const Manifest manifest = manifestOf(after.index()).value();
    const Manifest before = manifestOf(log.index()).value();
    ASSERT_EQ(before.levels.front().error.has_value(), measured);
    EXPECT_EQ(manifest.labels, (Labels{{"Region", {}}}));
    const auto region = static_cast<std::size_t>(
        std::ranges::find(manifest.fields, "Region", &ManifestField::name) -
        manifest.fields.begin());
    if (measured) EXPECT_EQ(manifest.levels.front().error->fields[region].max, 1) << "of a label";
    for (const ManifestLevel& level : manifest.levels) {
      ASSERT_EQ(level.error.has_value(), before.levels[level.level].error.has_value());
      if (!level.error) continue;
      ASSERT_EQ(level.error->fields.size(), manifest.fields.size());
      EXPECT_EQ(level.error->fields[1].rms > 0, level.level + 1 < manifest.levels.size())
          << level.level;
      EXPECT_EQ(level.error->toLevel.max, before.levels[level.level].error->toLevel.max);
    }
  }
}

TEST(AddFields, leavingFieldsOutGivesTheLogWithoutThem) {
  const Sample sample(5, 4, true), bare(5, 4, true);
  const LogFile log = sample.log();
  const auto some = withFields(log, {3, 0}, {});
  ASSERT_TRUE(some) << some.error().text();
  const LogFile left = LogFile::fromBytes(some->together()).value();
  const LatticeMesh mesh = meshAtLevel(left, 2).value(), whole = meshAtLevel(log, 2).value();
  ASSERT_EQ(mesh.fields.size(), 2u);
  EXPECT_EQ(mesh.values[0], whole.values[3]);
  EXPECT_EQ(mesh.values[1], whole.values[0]);
  EXPECT_EQ(withFields(log, allFields(log), {}).value().together(), sample.bytes);
}

TEST(AddFields, aDamagedBlockStaysFound) {
  Sample sample(5, 4, true);
  const BlockEntry block = sample.log().index().block(1, kFirstFieldPart);
  sample.bytes[static_cast<std::size_t>(block.offset)] ^= 1;
  const LogFile log = sample.log();
  const LogFile edited = LogFile::fromBytes(withFields(log, {0}, {}).value().together()).value();
  ASSERT_FALSE(edited.verifyChecksums());
  EXPECT_EQ(edited.verifyChecksums().error().code, ErrorCode::kBadChecksum);
}

TEST(AddFields, aMeshThatIsNotTheLogsIsRefusedByName) {
  const Sample sample(6, 0);
  const LogFile log = sample.log();
  const auto refusal = [&](const TetMesh& mesh) {
    const auto added = addFields(log, mesh);
    return added ? std::string("accepted") : added.error().text();
  };
  const TetMesh good = shuffled(sample.mesh, 0, 6);
  TetMesh moved = good;
  moved.points[7][0] += sample.mesh.lattice.step;
  EXPECT_NE(refusal(moved).find("point 7 "), std::string::npos) << refusal(moved);
  TetMesh between = good;
  between.points[9][1] += 0.7 * sample.mesh.lattice.step;
  EXPECT_NE(refusal(between).find("point 9 "), std::string::npos) << refusal(between);
  TetMesh fewer = good;
  fewer.tetrahedra.pop_back();
  EXPECT_NE(refusal(fewer).find("cells, the log"), std::string::npos) << refusal(fewer);
  TetMesh rewired = good;
  std::swap(rewired.tetrahedra[3][0], rewired.tetrahedra[4][0]);
  EXPECT_NE(refusal(rewired).find("is no cell of the log"), std::string::npos) << refusal(rewired);
}

TEST(MatchMesh, pointsAtOnePlaceAreToldApartByTheirCells) {
  // Two cells on either side of a crack: three pairs of points at the same places.
  LatticeMesh log;
  log.points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4},
                {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {9, 9, 9}};
  log.tetrahedra = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  LatticeMesh mesh = log;
  std::ranges::reverse(mesh.points);
  mesh.tetrahedra = {{1, 2, 3, 0}, {5, 4, 7, 6}};
  const auto match = matchMesh(mesh, log.points, log.tetrahedra);
  ASSERT_TRUE(match) << match.error().text();
  for (VertexId v = 0; v < 8; ++v) EXPECT_EQ(match->points[v], 7 - v);
  EXPECT_EQ(match->tetrahedra, (std::vector<CellId>{1, 0}));

  mesh.tetrahedra[0] = {1, 2, 7, 0};  // now a cell of both sides
  EXPECT_FALSE(matchMesh(mesh, log.points, log.tetrahedra));
  mesh.tetrahedra[0] = {1, 2, 6, 0};  // the right places, but one corner of the other side
  const auto crossed = matchMesh(mesh, log.points, log.tetrahedra);
  ASSERT_FALSE(crossed);
  EXPECT_NE(crossed.error().message.find("two points of the log"), std::string::npos)
      << crossed.error().message;
}

}  // namespace
}  // namespace qtet
