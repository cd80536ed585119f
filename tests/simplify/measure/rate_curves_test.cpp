// Error against bytes, as tests/bench/rate_distortion draws it: what is compared, what the ladder
// holds, and that the known errors are those of the bytes.
#include "tests/bench/parts/rate_curves.h"

#include <gtest/gtest.h>

#include <cmath>

#include "codec/files/atomic_file.h"
#include "codec/log/log_writer.h"
#include "simplify/clean/quantise.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/measure/measure_error.h"
#include "simplify/samples/samples.h"
#include "tests/bench/parts/direct_error.h"
#include "tests/support/meshes.h"

namespace qtet::bench {
namespace {

RateCurve curve(const std::vector<std::pair<double, double>>& points) {
  RateCurve out;
  for (const auto& [bytes, field] : points)
    out.push_back({bytes, static_cast<std::uint32_t>(out.size()), 2 * field, field});
  return out;
}

TEST(CompareCurves, aCurveIsNotAboveItself) {
  const RateCurve c = curve({{10, 0.5}, {20, 0.1}, {30, 0}});
  const Comparison found = compare(c, c, &RatePoint::field);
  EXPECT_EQ(found.places, 3u);
  EXPECT_EQ(found.above, 0u);
  EXPECT_EQ(found.worst, 1);
}

TEST(CompareCurves, everyImprovementOfEitherIsAPlace) {
  const RateCurve other = curve({{10, 0.5}, {40, 0.1}, {60, 0}});
  const Comparison found =
      compare(curve({{20, 0.4}, {30, 0.3}, {50, 0}}), other, &RatePoint::field);
  EXPECT_EQ(found.places, 6u);
  EXPECT_EQ(found.above, 2u);  // at 10, where it shows nothing, and at 40
  EXPECT_DOUBLE_EQ(found.worst, 3);
  EXPECT_EQ(found.worstBytes, 40);
}

TEST(CompareCurves, afterTheOthersEndAnyErrorIsAbove) {
  const Comparison found =
      compare(curve({{10, 0.5}, {90, 0}}), curve({{10, 1}, {80, 0}}), &RatePoint::boundary);
  EXPECT_EQ(found.above, 1u);  // at 80; of no error there is no multiple
  EXPECT_DOUBLE_EQ(found.worst, 0.5);
}

TEST(CompareCurves, bothBoundsHaveToBeKept) {
  const RateCurve c{{10, 0, 0.009, 0.06}, {20, 1, 0.02, 0.01}, {30, 2, 0.01, 0.05}, {40, 3, 0, 0}};
  EXPECT_EQ(firstWithin(c, 0.01, 0.05).bytes, 30);
  EXPECT_EQ(firstWithin(c, 0.02, 0.05).bytes, 20);
  EXPECT_EQ(firstWithin(c, 0.001, 0.001).bytes, 40);
}

/// The sample box, simplified to a fiftieth, with its known errors.
OpenedLog boxLog() {
  FusionOptions options;
  options.targetRatio = 0.02;
  auto mesh = quantise(boxSample()).value().mesh;
  options.cost.fieldWeights = {1};
  FusionHistory history = simplify(std::move(mesh), options).value();
  LogWriterOptions writing;
  writing.chunkBytes = 256;
  MeasureOptions measuring;
  measuring.levels.assign(history.levels + std::size_t{1}, 1);
  writing.errors = measureLevels(history, measuring).value();
  const auto path = testing::freshFolder("rate-curves") / "box.qtet";
  if (!writeFileAtomically(path, encodeLog(history, writing).value().bytes))
    throw std::runtime_error("box.qtet could not be written");
  return openLog(path).value();
}

TEST(RateCurves, aLogsCurveEndsWithTheWholeFileAndNoError) {
  const OpenedLog log = boxLog();
  const RateCurve c = logCurve(log).value();
  ASSERT_GT(c.size(), 5u);
  EXPECT_EQ(c.back().bytes, static_cast<double>(log.file.bytes().size()));
  EXPECT_EQ(c.back().field, 0);
  EXPECT_EQ(c.back().boundary, 0);
  EXPECT_EQ(c.front().bytes, static_cast<double>(log.prefixBytes(c.front().level)));
  for (std::size_t i = 1; i < c.size(); ++i) {
    EXPECT_GT(c[i].bytes, c[i - 1].bytes);
    EXPECT_GT(c[i].level, c[i - 1].level);
  }
}

TEST(RateCurves, theLadderIsMadeOfTheFinestLevelsThatFit) {
  const OpenedLog log = boxLog();
  const auto& levels = log.manifest.levels;
  const RateCurve ladder = ladderCurve(log).value();
  ASSERT_EQ(ladder.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const double most = levels.back().tetrahedra / std::array{64.0, 16.0, 4.0, 1.0}[i];
    const std::uint32_t level = ladder[i].level;
    if (level > 0) {
      EXPECT_LE(levels[level].tetrahedra, most);
    }
    if (level + 1 < levels.size()) {
      EXPECT_GT(levels[level + 1].tetrahedra, most);
    }
    EXPECT_EQ(ladder[i].field, levels[level].error->fields[0].rms);
    EXPECT_GT(ladder[i].bytes, i == 0 ? 0 : ladder[i - 1].bytes);
  }
  EXPECT_EQ(ladder.back().field, 0);
}

TEST(RateCurves, aStepOfTheLadderIsTheMeshAlone) {
  FusionOptions nothing;
  nothing.targetRatio = 1;
  nothing.cost.fieldWeights = {1};
  const FusionHistory history = simplify(quantise(boxSample()).value().mesh, nothing).value();
  const auto alone = static_cast<double>(encodeLog(history, {}).value().bytes.size());
  const RateCurve ladder = ladderCurve(boxLog()).value();
  // the same cells in another order
  EXPECT_NEAR(ladder[3].bytes - ladder[2].bytes, alone, 0.1 * alone);
}

TEST(RateCurves, aLogWithoutKnownErrorsIsRefused) {
  const OpenedLog log =
      openLog(testing::writeSampleLog(testing::freshFolder("rate-curves"))).value();
  const auto refused = logCurve(log);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNotFound);
}

/// A cube of 120 steps below z = height, its field the height and 50; in six tetrahedra.
LatticeMesh cube(int height) {
  LatticeMesh out;
  for (int v = 0; v < 8; ++v)
    out.points.push_back({v & 1 ? 120 : 0, v & 2 ? 120 : 0, v & 4 ? height : 0});
  out.tetrahedra = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                    {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  for (const Tetrahedron& t : out.tetrahedra)
    out.boundary.push_back({t[0], t[2], t[1]}), out.boundary.push_back({t[1], t[2], t[3]});
  out.values.resize(1);
  for (const LatticePoint& p : out.points) out.values[0].push_back(p[2] + 50);
  return out;
}

TEST(DirectError, ofAFlatSideMovedByAFifthIsWhatGeometrySays) {
  const DirectError direct = directError(cube(120), cube(96), 20000);
  // Not covered is a fifth of the volume, where the error is z - 96 of 120.
  const double field = std::sqrt(0.2 * 0.2 * 0.2 / 3);
  EXPECT_NEAR(direct.field, field, 0.02 * field);
  // From the old boundary: 24 on the top, 12 on the mean of four strips of 120 x 24. From the new
  // one it is less, for the sides are near.
  const double boundary =
      (120 * 120 * 24.0 + 4 * 120 * 24 * 12.0) / (6 * 120 * 120) / (120 * std::sqrt(3.0));
  EXPECT_NEAR(direct.boundary, boundary, 0.02 * boundary);
}

TEST(DirectError, isTheKnownErrorOfTheDecodedLevels) {
  const OpenedLog log = boxLog();
  const auto finest = static_cast<std::uint32_t>(log.manifest.levels.size() - 1);
  const LatticeMesh original = meshAtLevel(log.file, finest).value();
  for (const std::uint32_t level : {0u, finest / 2}) {
    const DirectError direct = directError(original, meshAtLevel(log.file, level).value(), 5000);
    const LevelError& known = *log.manifest.levels[level].error;
    EXPECT_GT(direct.field, 0);
    EXPECT_NEAR(direct.field, known.fields[0].rms, 0.08 * known.fields[0].rms);
    EXPECT_NEAR(direct.boundary, known.boundaryMean(), 0.08 * known.boundaryMean() + 1e-6);
  }
  const DirectError none = directError(original, original, 500);
  EXPECT_LT(none.field, 1e-9);
  EXPECT_LT(none.boundary, 1e-9);
}

}  // namespace
}  // namespace qtet::bench
