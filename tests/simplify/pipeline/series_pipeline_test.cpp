// Long series: a sample chooses the fusions, and all instants come back at the last level.
#include "simplify/pipeline/series_pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "codec/log/log_manifest.h"
#include "codec/refine/log_file.h"
#include "proto/field_name.h"
#include "proto/limits.h"
#include "proto/number_text.h"
#include "proto/rounding_error.h"
#include "simplify/read/options/time_steps.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using Steps = std::vector<std::size_t>;

TEST(SampledSteps, haveBothEndsAndEqualDistances) {
  EXPECT_EQ(sampledSteps(1), (Steps{0}));
  EXPECT_EQ(sampledSteps(kSampledInstants), (Steps{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(sampledSteps(15), (Steps{0, 2, 4, 6, 8, 10, 12, 14}));
  EXPECT_EQ(sampledSteps(1000).back(), 999u);
}

class SeriesPipeline : public ::testing::Test {
 protected:
  static constexpr std::size_t kSteps = 30;

  SeriesPipeline() {
    const LatticeMesh grid = testing::gridMesh(5, 3);
    for (const LatticePoint& p : grid.points) mesh_.points.push_back(grid.lattice.position(p));
    mesh_.tetrahedra = grid.tetrahedra;
  }

  /// T travels and jumps at one instant, which is none of the sample's; C counts on cells.
  [[nodiscard]] Result<TetMesh> read(std::span<const std::size_t> steps) const {
    TetMesh out = mesh_;
    for (const std::size_t step : steps) {
      MeshField t{"T@" + shortestText(0.1 * static_cast<double>(step)), 1, "float32", {}, "point"};
      for (const Position& p : out.points)
        t.values.push_back(static_cast<float>(
            (step < rest_    ? 0
             : step == jump_ ? factor_
                             : 1) *
            (p[0] + std::sqrt(1.0 + p[1] * p[1]) * 0.01 * static_cast<double>(step))));
      MeshField c{"C@" + shortestText(0.1 * static_cast<double>(step)), 1, "int32", {}, "cell"};
      for (std::size_t i = 0; i < out.tetrahedra.size(); ++i)
        c.values.push_back(static_cast<double>(i % 7 + step));
      out.fields.push_back(std::move(t)), out.fields.push_back(std::move(c));
    }
    return out;
  }
  [[nodiscard]] Result<PipelineOutput> make(const PipelineOptions& options = {}) const {
    return simplifySeries(
        read(sampledSteps(kSteps)).value(), kSteps,
        [&](std::span<const std::size_t> steps) { return read(steps); }, options);
  }

  TetMesh mesh_;
  std::size_t jump_ = kSteps;
  double factor_ = 5;
  std::size_t rest_ = 0;  ///< so many steps have T = 0
};

TEST_F(SeriesPipeline, everyInstantComesBackAtTheLastLevel) {
  jump_ = 5;
  const PipelineOutput made = make().value();
  const LogFile log = LogFile::fromBytes(made.log.bytes().value()).value();
  ASSERT_TRUE(log.verifyChecksums());
  const LatticeMesh finest = meshAtLevel(log, log.chunks().back().lastLevel, std::nullopt).value();
  ASSERT_EQ(finest.fields.size(), 2 * kSteps);
  ASSERT_EQ(made.report.manifest.fields.size(), 2 * kSteps);
  Steps all(kSteps);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const TetMesh input = read(all).value();
  std::map<LatticePoint, std::size_t> places;
  for (std::size_t i = 0; i < input.points.size(); ++i) {
    LatticePoint p{};
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = static_cast<std::int32_t>(
          std::lround((input.points[i][a] - finest.lattice.origin[a]) / finest.lattice.step));
    places[p] = i;
  }
  for (std::size_t f = 0; f < finest.fields.size(); ++f) {
    const FieldInfo& info = finest.fields[f];
    const auto from = std::ranges::find(input.fields, info.name, &MeshField::name);
    ASSERT_NE(from, input.fields.end()) << info.name;
    if (isCellField(info)) continue;
    for (std::size_t i = 0; i < finest.points.size(); ++i)
      ASSERT_NEAR(info.value(0, finest.values[f][i]), from->values[places.at(finest.points[i])],
                  0.501 * info.step)
          << info.name << " " << i;
  }
}

TEST_F(SeriesPipeline, aRunThatBeginsAtRestOpensWhereThereIsMostToSee) {
  rest_ = 3;
  Steps all(kSteps);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const PipelineReport atOnce = simplifyToLog(read(all).value(), {}).value().report,
                       inWindows = make().value().report;
  for (const PipelineReport* report : {&atOnce, &inWindows}) {
    const double time = report->manifest.fields[0].name.instant()->time;
    EXPECT_GT(time, 0.25);
    EXPECT_EQ(report->manifest.fields[1].name.instant()->time, time);
    EXPECT_EQ(report->manifest.fields.size(), 2 * kSteps);
    EXPECT_EQ(report->index.laterFields, 2 * (kSteps - 1));
    EXPECT_TRUE(report->index.fields[0].prediction.isNone());
  }
  PipelineOptions options;
  options.opensAtFirst = true;
  EXPECT_EQ(make(options).value().report.manifest.fields[0].name, "T@0");
}

TEST_F(SeriesPipeline, allInstantsOfASeriesHaveOneStepAndMostArePredicted) {
  jump_ = 5;
  const PipelineOutput made = make().value();
  std::size_t alone = 0;
  for (std::size_t f = 0; f < made.report.manifest.fields.size(); ++f) {
    const ManifestField& field = made.report.manifest.fields[f];
    if (field.association != "point") continue;
    EXPECT_EQ(field.step, made.report.manifest.fields[0].step) << field.name;
    alone += made.report.index.fields[f].prediction.isNone();
  }
  EXPECT_LE(alone, 3u);
}

TEST_F(SeriesPipeline, allInstantsOfASeriesAreWithinABoundByOneStep) {
  jump_ = 5;
  double low = 0, high = 0;  // of the sample, whose first values are 0
  for (const MeshField& field : read(sampledSteps(kSteps)).value().fields)
    if (!isCellField(field))
      for (const double value : field.values)
        low = std::min(low, value), high = std::max(high, value);
  const double range = high - low;
  for (const ValueBound& bound : {ValueBound{0.002}, {0.1, "%"}}) {
    PipelineOptions options;
    options.quantise.errors = {{"T", bound}};
    const PipelineOutput made = make(options).value();
    const double most = bound.isOfRange() ? bound.value / 100 * range : bound.value;
    std::size_t alone = 0;
    for (std::size_t f = 0; f < made.report.manifest.fields.size(); ++f) {
      const ManifestField& field = made.report.manifest.fields[f];
      if (field.association != "point") continue;
      EXPECT_EQ(field.step, made.report.manifest.fields[0].step) << field.name;
      EXPECT_LE(largestRoundingError(field), most) << field.name;
      EXPECT_GT(largestRoundingError(field), 0.9 * most) << field.name;
      alone += made.report.index.fields[f].prediction.isNone();
    }
    EXPECT_LE(alone, 3u);
  }
}

TEST_F(SeriesPipeline, instantsBelowTheRoomOfTheSampleGetRoomForTheirWindow) {
  jump_ = 5, factor_ = -5;
  const PipelineOutput made = make().value();
  const auto jump = std::ranges::find(made.report.manifest.fields, "T@0.5", &ManifestField::name);
  ASSERT_NE(jump, made.report.manifest.fields.end());
  EXPECT_EQ(jump->step, made.report.manifest.fields[0].step);
  EXPECT_EQ(jump->minimum, made.report.manifest.fields[0].minimum);
  EXPECT_LT(jump->minimum[0], jump->range[0]);
  EXPECT_TRUE(made.report.warnings.empty());
}

TEST_F(SeriesPipeline, aDivergedInstantHasItsOwnScaleAndIsToldOnce) {
  for (const std::size_t jump : {std::size_t{5}, kSteps - 1}) {  // beside the sample, and in it
    jump_ = jump, factor_ = 1e6;
    const PipelineOutput made = make().value();
    const std::string time = shortestText(0.1 * static_cast<double>(jump));
    const auto far = std::ranges::find(made.report.manifest.fields, FieldName("T@" + time),
                                       &ManifestField::name);
    EXPECT_GT(far->step, 1e3 * made.report.manifest.fields[0].step);
    ASSERT_EQ(made.report.warnings.size(), 1u);
    EXPECT_NE(made.report.warnings[0].find("its values at time " + time + " span"),
              std::string::npos)
        << made.report.warnings[0];
  }
}

/// A static field at the last level: what it is, and its integers by place, or sorted of cells.
struct Finest {
  FieldInfo info;
  std::map<LatticePoint, std::int32_t> ofPoints;
  std::vector<std::int32_t> ofCells;
};
std::map<std::string, Finest> staticFieldsOf(const PipelineOutput& made) {
  const LogFile log = LogFile::fromBytes(made.log.bytes().value()).value();
  const LatticeMesh mesh = meshAtLevel(log, log.chunks().back().lastLevel, std::nullopt).value();
  std::map<std::string, Finest> out;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    if (mesh.fields[f].name.instant()) continue;
    Finest& field = out[mesh.fields[f].name];
    field.info = mesh.fields[f];
    if (isCellField(field.info)) {
      field.ofCells = mesh.values[f];
      std::ranges::sort(field.ofCells);
    } else {
      for (std::size_t i = 0; i < mesh.points.size(); ++i)
        field.ofPoints[mesh.points[i]] = mesh.values[f][i];
    }
  }
  return out;
}

TEST_F(SeriesPipeline, statisticsAreOfAllInstantsAndTheSameAsAtOnce) {
  jump_ = 5;
  PipelineOptions options;
  options.timeStatistics = true;
  options.fieldWeights = {{"T_stddev", 2}};  // they are there when fusions are chosen
  Steps all(kSteps);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto inWindows = staticFieldsOf(make(options).value()),
             atOnce = staticFieldsOf(simplifyToLog(read(all).value(), options).value());
  ASSERT_EQ(inWindows.size(), 8u);
  ASSERT_EQ(atOnce.size(), 8u);
  for (const auto& [name, field] : inWindows) {
    const Finest& other = atOnce.at(name);
    EXPECT_EQ(field.info.type, other.info.type) << name;
    EXPECT_EQ(field.info.step, other.info.step) << name;
    EXPECT_EQ(field.info.minimum, other.info.minimum) << name;
    EXPECT_EQ(field.ofPoints, other.ofPoints) << name;
    EXPECT_EQ(field.ofCells, other.ofCells) << name;
  }
  EXPECT_EQ(inWindows.at("C_maximum").info.type, "int32");
  EXPECT_EQ(inWindows.at("C_maximum").info.range, (std::array<double, 2>{kSteps - 1, kSteps + 5}));
  EXPECT_NEAR(inWindows.at("C_average").info.minimum[0], (kSteps - 1) / 2.0, 1e-12);
}

TEST_F(SeriesPipeline, statisticsThatDoNotFitAreRefusedBeforeAStepIsRead) {
  PipelineOptions options;
  options.timeStatistics = true;
  const auto never = [](std::span<const std::size_t>) -> Result<TetMesh> {
    ADD_FAILURE() << "read";
    return fail(ErrorCode::kIo, "read");
  };
  const std::size_t most = (kMaxFields - 8) / 2;  // of two series
  const auto made = simplifySeries(read(sampledSteps(most + 1)).value(), most + 1, never, options);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kLimitExceeded);
  TetMesh taken = read(sampledSteps(kSteps)).value();
  taken.fields.push_back(taken.fields[0]);
  taken.fields.back().name = "T_average";
  EXPECT_EQ(simplifySeries(std::move(taken), kSteps, never, options).error().code,
            ErrorCode::kBadValue);
}

TEST_F(SeriesPipeline, refusesExactValuesAndPassesAReadersErrorOn) {
  PipelineOptions exact;
  exact.keep.exact = true;
  EXPECT_EQ(make(exact).error().code, ErrorCode::kBadValue);
  const auto broken = [](std::span<const std::size_t>) -> Result<TetMesh> {
    return fail(ErrorCode::kIo, "gone");
  };
  const auto made = simplifySeries(read(sampledSteps(kSteps)).value(), kSteps, broken, {});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace qtet
