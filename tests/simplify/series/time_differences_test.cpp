// Series in a log: every instant of every level comes back, in whatever order fields are decoded.
#include "simplify/series/time_differences.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <stop_token>

#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "codec/refine/log_edit.h"
#include "codec/refine/log_file.h"
#include "codec/refine/refiner.h"
#include "codec/refine/verify_log.h"
#include "simplify/clean/verify.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/mesh/missing_values.h"
#include "tests/support/forged_log.h"
#include "tests/support/series_mesh.h"
#include "tests/support/written_log.h"

namespace qtet {
namespace {

class TimeDifferences : public ::testing::Test {
 protected:
  static constexpr std::size_t kInstants = 11;

  explicit TimeDifferences(bool hasGaps = false) {
    LatticeMesh mesh = testing::seriesMesh(5, 1, kInstants);
    std::vector<std::vector<std::uint8_t>> missing(mesh.fields.size());
    if (hasGaps)
      for (const std::size_t f : {std::size_t{1}, std::size_t{3}, mesh.fields.size() - 1}) {
        mesh.fields[f].hasMissing = true;
        for (std::size_t i = 0; i < mesh.values[f].size(); ++i)
          missing[f].push_back(i % (5 + f) == 0);
      }
    history_ = simplify(mesh, {}).value();
    count_ = predictInTime(history_).value();
    restoreMissing(history_, missing);
    FusionHistory differences = history_;
    toTimeDifferences(differences);
    for (FieldInfo& field : history_.fields) field.prediction = {};
    LogWriterOptions options;
    options.chunkBytes = 600;
    bytes_ = encodeLog(differences, options).value().bytes;
    plain_ = encodeLog(history_, options).value().bytes.size();
  }
  [[nodiscard]] LogFile log() const { return LogFile::fromBytes(bytes_).value(); }

  FusionHistory history_;
  std::size_t count_ = 0, plain_ = 0;
  Bytes bytes_;
};

class WithGaps : public TimeDifferences {
 protected:
  WithGaps() : TimeDifferences(true) {}
};

void expectEveryLevel(const LogFile& log, const FusionHistory& history) {
  for (std::uint32_t level = 0; level <= history.levels; ++level) {
    const Result<LatticeMesh> mesh = meshAtLevel(log, level);
    ASSERT_TRUE(mesh) << mesh.error().text();
    const auto same = sameMesh(testing::meshOfHistory(history, level), *mesh);
    ASSERT_TRUE(same) << "level " << level << ": " << same.error().text();
  }
}

TEST_F(TimeDifferences, everyLevelHasEveryInstant) {
  EXPECT_GE(count_, kInstants - 2);
  EXPECT_LT(bytes_.size(), 3 * plain_ / 4);
  EXPECT_TRUE(log().index().hasSeries());
  expectEveryLevel(log(), history_);
  EXPECT_TRUE(decodeVerified(log(), manifestOf(log().index()).value()));
}

TEST_F(WithGaps, everyLevelHasEveryInstant) { expectEveryLevel(log(), history_); }

Refiner refinedTo(const LogFile& log, std::uint32_t level) {
  Refiner out(log.index());
  out.stopAtLevel(level);
  for (std::uint32_t chunk = 0; chunk == 0 || out.level() < level; ++chunk)
    EXPECT_TRUE(applyChunk(log, out, chunk, {}));
  return out;
}

void applyFields(const LogFile& log, Refiner& refiner, Association association) {
  for (std::uint32_t f = 0; f < log.fields().size(); ++f)
    if (log.fields()[f].association == association)
      for (std::uint32_t chunk = 0; chunk < refiner.chunksApplied(); ++chunk)
        ASSERT_TRUE(applyFieldBlock(log, refiner, chunk, f));
}

void expectSameAtFewElements(const LogFile& log, std::uint32_t level, Association association) {
  Refiner whole = refinedTo(log, level), few = refinedTo(log, level);
  const std::size_t count =
      association == Association::kPoint ? few.points().size() : few.tetrahedra().size();
  const auto last = static_cast<std::uint32_t>(count - 1);
  const std::array<std::uint32_t, 3> elements{last / 3, last, 0};
  few.fieldsOnlyAt(association, elements);
  applyFields(log, whole, association);
  applyFields(log, few, association);
  for (std::uint32_t f = 0; f < log.fields().size(); ++f) {
    const FieldShape& shape = log.fields()[f];
    if (shape.association != association) continue;
    for (const std::uint32_t e : elements)
      for (std::size_t i = e * shape.components; i < (e + 1) * shape.components; ++i)
        ASSERT_EQ(few.fieldValues(f)[i], whole.fieldValues(f)[i]) << "level " << level;
  }
}

void expectSameAtFewElements(const LogFile& log, std::uint32_t levels) {
  for (const std::uint32_t level : {0u, levels / 2, levels})
    for (const Association association : {Association::kPoint, Association::kCell})
      if (std::ranges::find(log.fields(), association, &FieldShape::association) !=
          log.fields().end())
        expectSameAtFewElements(log, level, association);
}

TEST_F(TimeDifferences, aFewElementsHaveTheValuesThatTheyHaveAmongAll) {
  expectSameAtFewElements(log(), history_.levels);
}

TEST(FewElements, pointsOfSeveralComponentsHaveTheValuesThatTheyHaveAmongAll) {
  LatticeMesh mesh = testing::gridMesh(5, 1);
  mesh.fields = {{"Swirl", 3, "float32", "point", 12, 0.25, {-3, 0, 2}, {-3, 1020}}};
  mesh.values.assign(1, {});
  for (const LatticePoint& p : mesh.points)
    for (const int axis : {2, 0, 1}) mesh.values[0].push_back((7 * p[axis] + p[0]) & 4095);
  const LogFile log = LogFile::fromBytes(testing::logBytes(mesh, {}, 600)).value();
  expectSameAtFewElements(log, log.index().chunks.back().lastLevel);
}

TEST_F(WithGaps, aFewElementsHaveTheValuesThatTheyHaveAmongAll) {
  expectSameAtFewElements(log(), history_.levels);
}

TEST_F(TimeDifferences, instantsOfAnotherScaleDoNotPredict) {
  history_.fields[0].minimum = {-4};
  ASSERT_TRUE(predictInTime(history_));
  for (const FieldInfo& field : history_.fields)
    for (const TimePrediction::Parent& parent : field.prediction.all())
      EXPECT_NE(parent.field, 0) << field.name;
}

/// The anchors that an anchor is decoded from, itself among them, at most. The series has equal
/// instants, where each may be predicted from the one before.
std::size_t longestRowOfAnchors(std::size_t anchors) {
  FusionHistory history;
  const std::vector<InstantStep> order = decodingOrder((anchors - 1) * kWindow + 1);
  for (const InstantStep& step : order) {
    const std::string name = "C@" + std::to_string(step.instant);
    history.fields.push_back({name, 1, "float32", "cell", 12, 0.5, {0}, {0, 900}});
    history.values.push_back({7, 1900, 30, 444});
  }
  EXPECT_TRUE(predictInTime(history));
  std::vector<std::size_t> rows(history.fields.size(), 1);
  std::size_t longest = 0;
  for (std::size_t f = 0; f < order.size(); ++f) {
    for (const TimePrediction::Parent& parent : history.fields[f].prediction.all())
      rows[f] = std::max(rows[f], rows[parent.field] + 1);
    if (order[f].isAnchor) longest = std::max(longest, rows[f]);
  }
  return longest;
}

TEST(Anchors, soManyStandInARowAndNoMore) {
  for (const std::size_t anchors : {kAnchorsInARow - 1, kAnchorsInARow, kAnchorsInARow + 1})
    EXPECT_EQ(longestRowOfAnchors(anchors), std::min(anchors, kAnchorsInARow)) << anchors;
}

TEST_F(TimeDifferences, workIsToldAndStopped) {
  std::vector<double> fractions;
  std::stop_source source;
  const Result<std::size_t> stopped =
      predictInTime(history_, source.get_token(), [&](double fraction) {
        fractions.push_back(fraction);
        if (fractions.size() == 3) source.request_stop();
      });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  const double instants = kInstants + 3;
  EXPECT_EQ(fractions, (std::vector<double>{1 / instants, 2 / instants, 3 / instants}));
}

TEST_F(TimeDifferences, anInstantIsReadWithoutTheOthersBytes) {
  const LogFile file = log();
  const auto last = static_cast<std::uint32_t>(file.index().fields.size() - 1);
  const Result<LatticeMesh> whole = meshAtLevel(file, history_.levels);
  for (std::uint32_t f = 0; f <= last; ++f) {
    const std::vector<std::uint32_t> needed = withParents(file.fields(), std::span(&f, 1));
    EXPECT_LE(needed.size(), 9u) << "seeking must stay cheap";
    const Result<LatticeMesh> one =
        meshAtLevel(file, history_.levels, std::vector<std::uint32_t>{f});
    ASSERT_TRUE(one) << one.error().text();
    EXPECT_EQ(one->values.at(0), whole->values[f]);
  }
}

TEST_F(TimeDifferences, aFieldWaitsForThoseThatItIsPredictedFrom) {
  const LogFile file = log();
  std::uint32_t child = 0;
  while (file.index().fields[child].prediction.isNone()) ++child;
  const std::uint32_t parent = file.index().fields[child].prediction.parents[0].field;
  Refiner refiner(file.index());
  ASSERT_TRUE(applyChunk(file, refiner, 0, {}));
  EXPECT_EQ(applyFieldBlock(file, refiner, 0, child).error().code, ErrorCode::kBadOrder);
  for (const std::uint32_t f : withParents(file.fields(), std::span(&parent, 1)))
    ASSERT_TRUE(applyFieldBlock(file, refiner, 0, f));
  EXPECT_EQ(applyFieldBlock(file, refiner, 0, child).has_value(),
            file.index().fields[child].prediction.count == 1);
}

/// Parents may be whole before the first block of the field comes.
void expectLateFieldsToEndTheSame(const LogFile& file) {
  const Result<LatticeMesh> whole = meshAtLevel(file, file.index().chunks.back().lastLevel);
  Refiner refiner(file.index());
  const auto chunks = static_cast<std::uint32_t>(file.index().chunks.size());
  for (std::uint32_t c = 0; c < chunks; ++c) ASSERT_TRUE(applyChunk(file, refiner, c, {}));
  for (std::uint32_t f = 0; f < file.index().fields.size(); ++f) {
    for (std::uint32_t c = 0; c < chunks; ++c) ASSERT_TRUE(applyFieldBlock(file, refiner, c, f));
    EXPECT_TRUE(std::ranges::equal(refiner.fieldValues(f), whole->values[f])) << f;
  }
}

TEST_F(TimeDifferences, aFieldThatComesLateEndsTheSame) { expectLateFieldsToEndTheSame(log()); }

/// Each instant is 32 times the one before it, and the range ends: in the same values, whether the
/// parents are ahead or not.
TEST_F(TimeDifferences, valuesStayInTheirRangeInEveryOrder) {
  for (std::uint16_t f = 1; f < kInstants; ++f) {
    const TimePrediction::Parent before{static_cast<std::uint16_t>(f - 1), 127};
    history_.fields[f].prediction = {{before, before, before, before}, 4};
  }
  LogWriterOptions options;
  options.chunkBytes = 600;
  bytes_ = encodeLog(history_, options).value().bytes;
  const LatticeMesh whole = meshAtLevel(log(), history_.levels).value();
  EXPECT_EQ(*std::ranges::max_element(whole.values[kInstants - 1]), 1 << 30);
  expectLateFieldsToEndTheSame(log());
}

TEST_F(TimeDifferences, fieldsGoOnlyBehindThoseThatRestOnThem) {
  const LogFile file = log();
  const auto fields = static_cast<std::uint32_t>(file.index().fields.size());
  std::vector<std::uint32_t> kept(fields - 1);
  std::iota(kept.begin(), kept.end(), 0u);
  const Result<EditedLog> shorter = withFields(file, kept, {});
  ASSERT_TRUE(shorter) << shorter.error().text();
  const LogFile left = LogFile::fromBytes(shorter->together()).value();
  EXPECT_EQ(meshAtLevel(left, 3)->values[5], meshAtLevel(file, 3)->values[5]);
  std::iota(kept.begin(), kept.end(), 1u);
  const Result<EditedLog> without = withFields(file, kept, {});
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().message.find("T@0"), std::string::npos) << without.error().message;
}

TEST_F(TimeDifferences, aTableThatLiesIsRefused) {
  const auto refused = [this](const std::function<void(LogIndex&)>& change) {
    testing::TakenApart parts = testing::takeApart(bytes_);
    change(parts.index);
    const Result<LogFile> file = LogFile::fromBytes(parts.together());
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ErrorCode::kBadValue) << file.error().text();
  };
  const auto fields = static_cast<std::uint16_t>(log().index().fields.size());
  for (const auto parent : {std::uint16_t{1}, std::uint16_t{2}, fields})
    refused([=](LogIndex& i) { i.fields[1].prediction = {{{{parent, 16}}}, 1}; });
  refused([=](LogIndex& i) {  // a point field from a cell field
    i.fields[fields - 1].prediction = {{{{0, 16}}}, 1};
  });
}

}  // namespace
}  // namespace qtet
