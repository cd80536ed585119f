// Values that are missing: a missing value is missing again at the last level, and takes nothing
// from its neighbours on the way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "codec/log/log_writer.h"
#include "codec/log/value_block.h"
#include "codec/record/values.h"
#include "codec/refine/log_file.h"
#include "simplify/clean/verify.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/mesh/missing_values.h"
#include "tests/support/forged_log.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

struct Sample {
  LatticeMesh mesh;  ///< its fields with missing values, kMissing in them
  FusionHistory history;
  Bytes bytes;
};

/// A share of the values of all fields missing, at random or (`blob`) within a ball round the
/// middle.
Sample sampleOf(std::uint32_t seed, double share, bool blob) {
  Sample out{testing::gridMesh(5, seed), {}, {}};
  testing::addCellFields(out.mesh);
  std::mt19937 random(seed);
  std::vector<std::vector<std::uint8_t>> missing;
  LatticeMesh filled = out.mesh;
  for (std::size_t f = 0; f < out.mesh.fields.size(); ++f) {
    FieldInfo& info = out.mesh.fields[f];
    info.hasMissing = filled.fields[f].hasMissing = true;
    std::vector<std::uint8_t>& isMissing = missing.emplace_back(out.mesh.values[f].size());
    for (std::size_t i = 0; i < isMissing.size(); ++i) {
      const std::size_t at = i / info.components;
      const LatticePoint& p = out.mesh.points[isCellField(info) ? out.mesh.tetrahedra[at][0] : at];
      const double x = p[0] - 160.0, y = p[1] - 160.0, z = p[2] - 160.0;
      isMissing[i] = blob ? std::sqrt(x * x + y * y + z * z) < 320 * share
                          : std::uniform_real_distribution<>(0, 1)(random) < share;
      if (isMissing[i] != 0) out.mesh.values[f][i] = kMissing, filled.values[f][i] = 0;
    }
    fillMissing(filled.tetrahedra, info, isMissing, filled.values[f]);
  }
  out.history = simplify(std::move(filled), {}).value();
  restoreMissing(out.history, missing);
  LogWriterOptions writer;
  writer.chunkBytes = 200;
  out.bytes = encodeLog(out.history, writer).value().bytes;
  return out;
}

class MissingValues : public ::testing::TestWithParam<std::tuple<std::uint32_t, double, bool>> {};

TEST_P(MissingValues, comeBackAtEveryLevelAsTheyWereWritten) {
  const auto [seed, share, blob] = GetParam();
  const Sample sample = sampleOf(seed, share, blob);
  const LogFile log = LogFile::fromBytes(sample.bytes).value();
  for (std::uint32_t level = 0; level <= sample.history.levels; ++level) {
    const auto mesh = meshAtLevel(log, level);
    ASSERT_TRUE(mesh) << mesh.error().text();
    for (const FieldInfo& field : mesh->fields) EXPECT_TRUE(field.hasMissing);
    const auto same = sameMesh(*mesh, level == sample.history.levels
                                          ? sample.mesh
                                          : testing::meshOfHistory(sample.history, level));
    ASSERT_TRUE(same) << "level " << level << ": " << same.error().text();
  }
}

TEST_P(MissingValues, aFusedVertexIsAGapOnlyWhereAllThatItStandsForIs) {
  const auto [seed, share, blob] = GetParam();
  const Sample sample = sampleOf(seed, share, blob);
  const FusionHistory& h = sample.history;
  for (std::size_t f = 0; f < h.fields.size(); ++f) {
    if (isCellField(h.fields[f])) continue;
    const std::size_t n = h.fields[f].components;
    for (const Fusion& fusion : h.fusions)
      for (std::size_t c = 0; c < n; ++c) {
        std::size_t missing = 0;
        for (std::size_t i = 0; i < fusion.k; ++i)
          missing += h.values[f][fusion.prey[i] * n + c] == kMissing;
        ASSERT_EQ(h.values[f][fusion.fused * n + c] == kMissing, missing == fusion.k);
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Shares, MissingValues,
                         ::testing::Values(std::tuple{1u, 0.02, false}, std::tuple{2u, 0.5, false},
                                           std::tuple{3u, 0.97, false}, std::tuple{4u, 1.1, false},
                                           std::tuple{5u, 0.4, true}));

TEST(MissingValues, aSmoothFieldWithAHoleTakesFewMoreBytesThanWithout) {
  const auto fieldBytes = [](const Bytes& bytes) {
    const LogIndex index = LogIndex::parse(bytes).value();
    std::uint64_t sum = 0;
    for (const ChunkEntry& chunk : index.chunks) sum += chunk.blocks[kFirstFieldPart].size;
    return sum;
  };
  const std::uint64_t whole = fieldBytes(sampleOf(7, 0, true).bytes),
                      hole = fieldBytes(sampleOf(7, 0.3, true).bytes);
  EXPECT_LT(static_cast<double>(hole), 1.15 * static_cast<double>(whole));
}

TEST(MissingValues, fillingTakesTheNearestValueAndReachesAllOfThePart) {
  const LatticeMesh mesh = testing::gridMesh(3, 1);
  FieldInfo info{.name = "f", .components = 2, .minimum = {0, 0}};
  std::vector<std::int32_t> values(mesh.points.size() * 2, 0);
  std::vector<std::uint8_t> missing(values.size(), 1);
  missing[0] = missing[11] = 0;
  values[0] = 17, values[11] = 23;
  fillMissing(mesh.tetrahedra, info, missing, values);
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(values[i], i % 2 == 0 ? 17 : 23);
}

TEST(Values, aGapIsZeroAndDifferencesStepOverIt) {
  Values told;
  const std::vector<std::pair<std::int64_t, std::int32_t>> cases{
      {5, 5}, {5, 6}, {5, 4}, {5, kMissing}, {-7, -7}, {-7, kMissing}, {1 << 28, 0}, {0, 1 << 28}};
  for (const auto& [predicted, truth] : cases)
    EXPECT_EQ(told.codeOrMissing<true>(predicted, truth), truth);
  EXPECT_EQ(told.written(),
            (std::vector<std::int32_t>{1, 2, -1, 0, 1, 0, -(1 << 28), (1 << 28) + 1}));
  Values back(told.written());
  for (const auto& [predicted, truth] : cases)
    EXPECT_EQ(back.codeOrMissing<false>(predicted, 0), truth);
  EXPECT_TRUE(back.atEnd());
  EXPECT_FALSE(back.bad());
}

TEST(MissingValues, anEveryBlockOfNoiseIsDecodedOrRefused) {
  const Sample sample = sampleOf(9, 0.3, false);
  std::mt19937 random(9);
  for (int round = 0; round < 40; ++round) {
    testing::TakenApart log = testing::takeApart(sample.bytes);
    for (std::uint32_t part = kFirstFieldPart; part < log.index.parts(); ++part) {
      std::vector<std::int32_t> noise(std::size_t{log.index.tuples(0, part)} *
                                      log.index.components(part));
      for (std::int32_t& x : noise)
        x = static_cast<std::int32_t>(random() % 5) * (round % 2 == 0 ? 1 : 1 << 18) - 2;
      const CodecId codec = log.index.blockCodec(0, part);
      Bytes& block = log.blocks[0][part];
      if (codec == CodecId::kLifted)
        for (std::uint8_t& byte : block) byte = static_cast<std::uint8_t>(random());
      else
        block = encodeValueBlock(noise, log.index.components(part), codec).value();
    }
    const LogFile file = LogFile::fromBytes(log.together()).value();
    const auto mesh = meshAtLevel(file, file.index().chunks.back().lastLevel);
    if (!mesh) {
      EXPECT_TRUE(mesh.error().code == ErrorCode::kBadValue ||
                  mesh.error().code == ErrorCode::kTruncated)
          << mesh.error().text();
      continue;
    }
    for (std::size_t f = 0; f < mesh->fields.size(); ++f)
      for (const std::int32_t value : mesh->values[f])
        ASSERT_TRUE(value == kMissing || std::abs(value) <= 1 << 30);
  }
}

// A cell after the other would look at all of them: a thousand thousand million looks.
TEST(FillMissingValues, aCellFieldIsFilledInLinearTimeWhereAMillionCellsMeet) {
  constexpr std::uint32_t kCells = 1'000'000;
  std::vector<Tetrahedron> cells;
  for (std::uint32_t i = 0; i < kCells; ++i) cells.push_back({0, 3 * i + 1, 3 * i + 2, 3 * i + 3});
  cells.push_back({3, 3 * kCells + 1, 3 * kCells + 2, 3 * kCells + 3});  // behind the first of them
  FieldInfo field;
  field.association = "cell";
  std::vector<std::int32_t> values(cells.size(), 7);
  std::vector<std::uint8_t> missing(cells.size());
  for (const std::size_t isMissing : {std::size_t{5}, std::size_t{kCells}})
    missing[isMissing] = 1, values[isMissing] = 0;
  values[0] = 9;
  fillMissing(cells, field, missing, values);
  EXPECT_EQ(values[5], 9) << "the first cell round the point they share";
  EXPECT_EQ(values[kCells], 9);
}

}  // namespace
}  // namespace qtet
