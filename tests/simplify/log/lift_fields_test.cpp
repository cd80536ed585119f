// Fused values that move so that their corrections take few bits: by how much, and what is said of
// it.
#include "simplify/log/lift_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "codec/log/log_writer.h"
#include "codec/refine/log_file.h"
#include "codec/refine/log_history.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/measure/measure_error.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/series/time_differences.h"
#include "tests/support/meshes.h"
#include "tests/support/series_mesh.h"

namespace qtet {
namespace {

using Missing = std::vector<std::vector<std::uint8_t>>;

/// A history that is measured, with the geometry of its log.
struct Made {
  FusionHistory history;
  FieldReplay replay;
  LevelErrors errors;
  LogWriterOptions writing{.chunkBytes = 600};
  std::unique_ptr<LogEncoder> encoder;

  explicit Made(LatticeMesh mesh) : history(simplify(std::move(mesh), {}).value()) {
    EXPECT_TRUE(predictInTime(history));
    errors = measured(&replay);
    encoder = std::make_unique<LogEncoder>(history, writing);
    EXPECT_TRUE(encoder->writeGeometry());
  }
  [[nodiscard]] LevelErrors measured(FieldReplay* where = nullptr) {
    MeasureOptions options;
    options.levels.assign(history.levels + std::size_t{1}, 1);
    options.countsRounding = true;
    options.replay = where;
    return measureLevels(history, options).value();
  }
  [[nodiscard]] std::vector<LiftingRules> lift(LiftOptions options = {}) {
    options.replay = &replay;
    return liftFields(history, encoder->order(), errors, options).value();
  }
};

/// A field over the range of 12 bits, as quantising makes it.
LatticeMesh meshOf(std::uint32_t seed) {
  LatticeMesh mesh = testing::gridMesh(6, seed);
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    mesh.fields[f].type = "float32";
    mesh.fields[f].bits = 12;
    for (std::int32_t& value : mesh.values[f]) value = std::clamp(value * 37, 0, 4095);
  }
  return mesh;
}

bool hasUnits(const std::vector<LiftingRules>& all) {
  return std::ranges::any_of(all, [](const LiftingRules& rules) {
    return std::ranges::any_of(rules, [](const LiftingRule& rule) { return rule.shift > 0; });
  });
}

TEST(LiftFields, errorsGrowLittleAndAreThoseOfTheMovedValues) {
  Made made(meshOf(1));
  const FusionHistory before = made.history;
  const LevelErrors was = made.errors;
  const auto rules = made.lift();
  EXPECT_TRUE(hasUnits(rules));
  EXPECT_NE(made.history.values, before.values);
  const LevelErrors again = made.measured();
  const std::size_t finest = was.back()->fields.size();
  for (std::size_t level = 0; level < was.size(); ++level) {
    if (!was[level]) continue;
    for (std::size_t f = 0; f < finest; ++f) {
      EXPECT_EQ(made.errors[level]->fields[f].rms, again[level]->fields[f].rms) << level;
      EXPECT_EQ(made.errors[level]->fields[f].max, again[level]->fields[f].max) << level;
    }
    EXPECT_EQ(made.errors[level]->boundaryDistance(), was[level]->boundaryDistance());
  }
  for (std::size_t f = 0; f < finest; ++f)
    EXPECT_LE(made.errors[0]->fields[f].rms, 1.05 * was[0]->fields[f].rms);
}

TEST(LiftFields, theLogHasTheMovedValues) {
  Made made(meshOf(2));
  const FusionHistory before = made.history;
  made.encoder->options().rules = made.lift();
  Bytes body;
  const auto head = made.encoder->finish(appendTo(body));
  ASSERT_TRUE(head) << head.error().text();
  Bytes bytes = head->head;
  bytes.insert(bytes.end(), body.begin(), body.end());
  const LogFile log = LogFile::fromBytes(bytes).value();
  // a level's values by place, since a log has a numbering of its own
  const auto placesOf = [](const FusionHistory& history, std::span<const std::int32_t> values) {
    std::vector<std::pair<LatticePoint, std::int32_t>> out;
    for (std::size_t v = 0; v < history.points.size(); ++v)
      out.emplace_back(history.points[v], values[v]);
    std::ranges::sort(out);
    return out;
  };
  const LogHistory decoded = historyOf(log).value();
  for (std::uint32_t f = 0; f < before.fields.size(); ++f) {
    if (before.fields[f].components > 1) continue;
    EXPECT_EQ(placesOf(decoded.history, historyValues(log, decoded, f).value()),
              placesOf(made.history, made.history.values[f]));
  }
  EXPECT_LT(bytes.size(), encodeLog(before, made.writing).value().bytes.size());
}

TEST(LiftFields, valuesStayInTheirRangeAndThoseOfTheLastLevelStay) {
  Made made(meshOf(3));
  const FusionHistory before = made.history;
  static_cast<void>(made.lift());
  const std::size_t finest = std::ranges::min_element(before.fusions, {}, &Fusion::fused)->fused;
  for (std::size_t f = 0; f < before.fields.size(); ++f) {
    const std::size_t n = before.fields[f].components;
    for (std::size_t i = 0; i < before.values[f].size(); ++i)
      if (i < finest * n) ASSERT_EQ(made.history.values[f][i], before.values[f][i]);
    for (std::size_t c = 0; c < n; ++c) {
      std::int32_t least = 4096, most = -1, movedLeast = 4096, movedMost = -1;
      for (std::size_t i = c; i < before.values[f].size(); i += n) {
        least = std::min(least, before.values[f][i]), most = std::max(most, before.values[f][i]);
        movedLeast = std::min(movedLeast, made.history.values[f][i]);
        movedMost = std::max(movedMost, made.history.values[f][i]);
      }
      EXPECT_GE(movedLeast, least);
      EXPECT_LE(movedMost, most);
    }
  }
}

TEST(LiftFields, nothingMovesUnmeasuredOrWhereItIsExact) {
  Made made(meshOf(4));
  const FusionHistory before = made.history;
  const auto rules = liftFields(made.history, made.encoder->order(), made.errors, {}).value();
  EXPECT_EQ(made.history.values, before.values);
  EXPECT_FALSE(hasUnits(rules));
  LiftOptions exact;
  for (std::size_t f = 0; f < before.fields.size(); ++f) exact.exact.push_back(f);
  EXPECT_FALSE(hasUnits(made.lift(exact)));
  EXPECT_EQ(made.history.values, before.values);
  made.history.fields[0].type = "int32";
  static_cast<void>(made.lift());
  EXPECT_EQ(made.history.values[0], before.values[0]);
}

// All instants stand on others that have moved; some values are missing.
TEST(LiftFields, instantsAndGapsComeBack) {
  LatticeMesh mesh = testing::seriesMesh(7, 1, 11);
  Missing missing(mesh.fields.size());
  for (const std::size_t f : {std::size_t{1}, mesh.fields.size() - 1}) {
    mesh.fields[f].hasMissing = true;
    for (std::size_t i = 0; i < mesh.values[f].size(); ++i) missing[f].push_back(i % 61 == 0);
  }
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) mesh.fields[f].type = "float64";
  Made made(mesh);
  const FusionHistory before = made.history;
  made.encoder->options().rules = made.lift({.missing = missing});
  EXPECT_NE(made.history.values, before.values);
  for (const auto& values : made.history.values) EXPECT_EQ(std::ranges::count(values, kMissing), 0);
  restoreMissing(made.history, missing);
  const FusionHistory whole = made.history;
  toTimeDifferences(made.history);
  Bytes body;
  const auto head = made.encoder->finish(appendTo(body));
  ASSERT_TRUE(head) << head.error().text();
  FusionHistory exact = before;
  restoreMissing(exact, missing);
  toTimeDifferences(exact);
  EXPECT_LT(head->statistics.fileBytes,
            encodeLog(exact, made.writing).value().statistics.fileBytes);
}

TEST(LiftFields, endsAtAStop) {
  Made made(meshOf(5));
  std::stop_source stop;
  stop.request_stop();
  LiftOptions options;
  options.stop = stop.get_token();
  const auto rules = liftFields(made.history, made.encoder->order(), made.errors, options);
  ASSERT_FALSE(rules);
  EXPECT_EQ(rules.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace qtet
