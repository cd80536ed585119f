#include "simplify/measure/measure_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "codec/coding/error_figure.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/measure/farthest_point.h"
#include "simplify/measure/label_volumes.h"
#include "simplify/measure/measure_samples.h"
#include "simplify/measure/measured_mesh.h"
#include "simplify/mesh/split_mix64.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::gridMesh;

/// A cube of 120 steps, cut into six tetrahedra round the diagonal from 0 to 7, with a field.
/// Vertex v lies where its bits say.
FusionHistory cube() {
  FusionHistory h;
  h.lattice = {8, 1, {0, 0, 0}};
  for (int v = 0; v < 8; ++v)
    h.points.push_back({v & 1 ? 120 : 0, v & 2 ? 120 : 0, v & 4 ? 120 : 0});
  h.cells = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  for (const auto& cell : std::vector(h.cells)) {
    h.cells.push_back({cell[0], cell[2], cell[1], kGhost});
    h.cells.push_back({cell[1], cell[2], cell[3], kGhost});
  }
  h.live.assign(h.cells.size(), 1);
  h.fields = {{"Height", 1, "float32", "point", 12, 1, {0}, {0, 120}}};
  h.values.resize(1);
  for (const LatticePoint& p : h.points) h.values[0].push_back(p[2]);
  return h;
}

/// The vertex goes to `point` and gets `value`: a fusion of one vertex alone, which is all that a
/// measurement needs to see. One level more.
void displace(FusionHistory& h, VertexId vertex, const LatticePoint& point, std::int32_t value) {
  Fusion fusion;
  fusion.k = 1;
  fusion.placement = Placement::kFree;
  fusion.level = h.levels++;
  fusion.fused = static_cast<VertexId>(h.points.size());
  fusion.prey[0] = vertex;
  fusion.firstAffected = h.affectedCells.size();
  h.points.push_back(point);
  h.values[0].push_back(value);
  for (std::uint32_t c = 0; c < h.cells.size(); ++c)
    if (const auto at = std::ranges::find(h.cells[c], vertex); at != h.cells[c].end()) {
      *at = fusion.fused;
      h.affectedCells.push_back(c);
      h.affectedLabels.push_back(0);
      ++fusion.affectedCount;
    }
  h.fusions.push_back(fusion);
}

/// Measures every level.
std::vector<LevelError> measured(FusionHistory h, MeasureOptions options = {}) {
  options.levels.assign(h.levels + std::size_t{1}, 1);
  const auto errors = measureLevels(h, options);
  if (!errors) throw std::runtime_error(errors.error().message);
  std::vector<LevelError> out;
  for (const auto& error : *errors) out.push_back(error.value());
  return out;
}

void expectNothing(const LevelError& error) {
  EXPECT_EQ(error.boundaryDistance(), 0);
  EXPECT_EQ(error.boundaryMean(), 0);
  EXPECT_EQ(error.volumeLost, 0);
  EXPECT_EQ(error.volumeGained, 0);
  for (const FieldError& field : error.fields) {
    EXPECT_EQ(field.rms, 0);
    EXPECT_EQ(field.max, 0);
  }
}

constexpr double kDiagonal = 120 * 1.7320508075688772;

TEST(MeasureLevels, theOriginalHasNoError) {
  const auto errors = measured(cube());
  ASSERT_EQ(errors.size(), 1u);
  ASSERT_EQ(errors[0].fields.size(), 1u);
  expectNothing(errors[0]);
}

TEST(MeasureLevels, aVertexPutIntoItsOwnPlaceChangesNothing) {
  FusionHistory h = cube();
  displace(h, 7, h.points[7], h.values[0][7]);
  const auto errors = measured(h);
  ASSERT_EQ(errors.size(), 2u);
  for (const LevelError& error : errors) {
    EXPECT_LT(error.boundaryDistance(), 1e-12);
    EXPECT_EQ(error.volumeLost, 0);
    EXPECT_EQ(error.volumeGained, 0);
    EXPECT_LE(error.fields[0].max, 1e-12);
  }
}

TEST(MeasureLevels, aCornerPulledInIsAsFarAsItsOldPlaceIs) {
  FusionHistory h = cube();
  displace(h, 1, {90, 0, 0}, 0);  // the corner at (120, 0, 0)
  const LevelError error = measured(h)[0];
  // The distance of the old corner from the plane 4 x - y = 360 of the new triangle with 3 and 7.
  const double distance = 120 / std::sqrt(17.0) / kDiagonal;
  EXPECT_GE(error.toLevel.max, roundedUp(distance));
  EXPECT_LE(error.toLevel.max, roundedUp((1 + kFarthestTolerance) * distance));
  // The tetrahedra (0, 1, 3, 7) and (0, 5, 1, 7) are a sixth each. They lose a quarter of their
  // height over the plane through 0, 3, 7 or 0, 5, 7.
  EXPECT_EQ(error.volumeLost, 0.083333);
  EXPECT_EQ(error.volumeGained, 0);
  // The new corner lies on the original's boundary, the inside of the new triangles does not.
  EXPECT_GT(error.toOriginal.max, 0);
  EXPECT_LE(error.toOriginal.max, error.toLevel.max);
}

TEST(MeasureLevels, aFlatSideMovedByAFifthIsAFifthAway) {
  FusionHistory h = cube();
  for (const VertexId v : {4u, 5u, 6u, 7u})
    // four levels; the base has the side z = 96
    displace(h, v, {h.points[v][0], h.points[v][1], 96}, 96);
  const auto errors = measured(h);
  ASSERT_EQ(errors.size(), 5u);
  const LevelError& base = errors.front();
  EXPECT_EQ(base.toLevel.max, roundedUp(24 / kDiagonal));
  EXPECT_EQ(base.toOriginal.max, roundedUp(24 / kDiagonal));  // in the middle of the new side
  EXPECT_EQ(base.volumeLost, 0.2);
  EXPECT_EQ(base.volumeGained, 0);
  // A fifth of the volume is not covered; there the error is z - 96 of 120, elsewhere there is
  // none.
  EXPECT_EQ(base.fields[0].max, 0.2);
  const double rms = std::sqrt(0.2 * 0.2 * 0.2 / 3);
  EXPECT_NEAR(base.fields[0].rms, rms, 0.08 * rms);
  expectNothing(errors.back());
}

TEST(MeasureLevels, aWrongValueIsTheErrorAtItsVertex) {
  FusionHistory h = cube();
  // a quarter of the range too much at a corner that every cell has
  displace(h, 7, h.points[7], 120 + 30);
  const LevelError error = measured(h)[0];
  EXPECT_EQ(error.fields[0].max, 0.25);
  const double rms = 0.25 * std::sqrt(0.1);  // of a barycentric coordinate in a tetrahedron
  EXPECT_NEAR(error.fields[0].rms, rms, 0.05 * rms);
  EXPECT_LT(error.boundaryDistance(), 1e-12);
}

TEST(MeasureLevels, aVectorsErrorIsTheLengthOfTheDifference) {
  FusionHistory h = cube();
  h.fields.push_back({"Place", 3, "float32", "point", 8, 1, {0, 0, 0}, {0, 208}});
  h.values.emplace_back();
  for (const LatticePoint& p : h.points) h.values[1].insert(h.values[1].end(), p.begin(), p.end());
  displace(h, 7, h.points[7], 120);
  h.values[1].insert(h.values[1].end(), {120 - 30, 120 - 60, 120 - 60});  // off by 90
  const LevelError error = measured(h)[0];
  EXPECT_GE(error.fields[1].max, 90 / kDiagonal);  // the values fill the same box as the points
  EXPECT_LE(error.fields[1].max, 1.01 * 90 / kDiagonal);  // three digits, rounded up
  EXPECT_LE(error.fields[0].max, 1e-12);
}

TEST(MeasureLevels, aConstantFieldHasNoErrorAtAll) {
  FusionHistory h = cube();
  h.values[0].assign(8, 5);
  displace(h, 7, {100, 100, 100}, 5);
  EXPECT_EQ(measured(h)[0].fields[0].max, 0);
}

/// Simplified with the field x + 2 y + 3 z on a convex solid. Nothing has moved, and every value is
/// linear between vertices.
TEST(MeasureLevels, aLinearFieldOnAConvexSolidLosesNothingWhileTheBoundaryStays) {
  LatticeMesh mesh = gridMesh(6, 5);
  mesh.fields.resize(1);
  mesh.values.resize(1);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    mesh.values[0][v] = mesh.points[v][0] + 2 * mesh.points[v][1] + 3 * mesh.points[v][2];
  auto history = simplify(mesh, {});
  ASSERT_TRUE(history);
  // also of fused vertices: what is measured here is measuring
  for (std::size_t v = 0; v < history->points.size(); ++v) {
    const LatticePoint& p = history->points[v];
    history->values[0][v] = p[0] + 2 * p[1] + 3 * p[2];
  }
  for (const LevelError& error : measured(*history)) {
    // Where the solid has gone, at most its largest slope times the distance, over the range 6 *
    // 384.
    const double diagonal = 384 * std::sqrt(3.0);
    EXPECT_LE(error.fields[0].max,
              error.toLevel.max * diagonal * std::sqrt(14.0) / (6 * 384) * 1.01 + 1e-9);
  }
}

TEST(MeasureLevels, coarserLevelsAreFurtherAndSmaller) {
  FusionOptions options;
  options.envelopeTolerance = 0;  // each level is part of the finer one
  auto history = simplify(gridMesh(7, 2), options);
  ASSERT_TRUE(history);
  const auto errors = measured(*history);
  ASSERT_EQ(errors.size(), history->levels + 1u);
  for (std::size_t i = 1; i < errors.size(); ++i) {
    EXPECT_GE(errors[i - 1].volumeLost, errors[i].volumeLost) << i;
    EXPECT_EQ(errors[i].volumeGained, 0) << i;
    EXPECT_GE(errors[i - 1].toLevel.max * (1 + kFarthestTolerance), errors[i].toLevel.max) << i;
    EXPECT_GE(errors[i - 1].toLevel.mean, errors[i].toLevel.mean) << i;
    EXPECT_GE(errors[i].toLevel.max, errors[i].toLevel.mean);
    EXPECT_GE(errors[i].toOriginal.max, errors[i].toOriginal.mean);
  }
  EXPECT_GT(errors.front().fields[0].rms, 0);
  expectNothing(errors.back());
}

bool same(const LevelError& a, const LevelError& b) {
  const auto sameWay = [](const OneSidedDistance& x, const OneSidedDistance& y) {
    return x.mean == y.mean && x.max == y.max;
  };
  const auto sameField = [](const FieldError& x, const FieldError& y) {
    return x.rms == y.rms && x.max == y.max;
  };
  return sameWay(a.toLevel, b.toLevel) && sameWay(a.toOriginal, b.toOriginal) &&
         a.volumeLost == b.volumeLost && a.volumeGained == b.volumeGained &&
         std::ranges::equal(a.fields, b.fields, sameField);
}

TEST(MeasureLevels, theFiguresDependNeitherOnTheRunNorOnTheThreads) {
  auto history = simplify(gridMesh(8, 4), {});
  ASSERT_TRUE(history);
  const auto once = measured(*history);
  MeasureOptions options;
  for (const int threads : {1, 2, 7}) {
    options.threads = threads;
    EXPECT_TRUE(std::ranges::equal(measured(*history, options), once, same))
        << threads << " threads";
  }
  options.seed = 2;
  EXPECT_FALSE(std::ranges::equal(measured(*history, options), once, same))
      << "the seed has no effect";
}

TEST(MeasureLevels, moreSamplesAgreeWithFewer) {
  FusionOptions half;
  half.targetRatio = 0.7;
  auto history = simplify(gridMesh(7, 6), half);
  ASSERT_TRUE(history);
  MeasureOptions options;
  options.effort = Effort::kAll;
  options.threads = 2;
  const auto few = measured(*history), many = measured(*history, options);
  for (std::size_t i = 0; i < few.size() / 2; ++i) {
    EXPECT_NEAR(few[i].fields[0].rms, many[i].fields[0].rms, 0.1 * many[i].fields[0].rms) << i;
    EXPECT_NEAR(few[i].fields[1].rms, many[i].fields[1].rms, 0.1 * many[i].fields[1].rms) << i;
    EXPECT_NEAR(few[i].volumeGained - few[i].volumeLost, many[i].volumeGained - many[i].volumeLost,
                2e-6)
        << i;
    EXPECT_NEAR(few[i].volumeLost, many[i].volumeLost, 0.2 * many[i].volumeLost + 0.002) << i;
  }
}

/// The largest distance of places all over the triangles `ids` to the tree, over the diagonal.
double sampledMaximum(const FusionHistory& h, std::span<const TriangleTree::Cell> cells,
                      const std::vector<std::uint32_t>& ids, const TriangleTree& tree) {
  double squared = 0;
  for (const ErrorSample& sample : samplesOnSurface(h.points, cells, ids, 40000, 99)) {
    NearestTriangle nearest;
    tree.nearest(sample.at, nearest);
    squared = std::max(squared, nearest.point.squared);
  }
  for (const std::uint32_t id : ids)
    for (std::size_t c = 0; c < 3; ++c) {
      NearestTriangle nearest;
      tree.nearest(toVector(h.points[cells[id][c]]), nearest);
      squared = std::max(squared, nearest.point.squared);
    }
  return std::sqrt(squared);
}

TEST(MeasureLevels, noPlaceOfALevelOrOfTheOriginalIsFurtherThanItsMaximum) {
  for (const std::uint32_t seed : {3u, 6u}) {
    FusionOptions far;
    far.targetRatio = 0.002;
    auto history = simplify(gridMesh(5 + seed % 3, seed), far);
    ASSERT_TRUE(history);
    const auto errors = measured(*history);
    HistoryLevels levels(*history);
    MeasuredMesh mesh(levels);
    std::vector<std::uint32_t> all(mesh.originalTriangles().size());
    std::iota(all.begin(), all.end(), 0u);
    for (std::size_t level = errors.size(); level-- > 0;) {
      const double toLevel =
          sampledMaximum(*history, mesh.originalTriangles(), all, mesh.boundaryTree());
      const double toOriginal =
          sampledMaximum(*history, history->cells, mesh.boundary(), mesh.originalTree());
      EXPECT_GE(errors[level].toLevel.max * mesh.diagonal(), toLevel - 1e-6) << level;
      EXPECT_GE(errors[level].toOriginal.max * mesh.diagonal(), toOriginal - 1e-6) << level;
      // a triangle's search ends after 400 places
      EXPECT_LE(errors[level].toLevel.max * mesh.diagonal(), 1.2 * toLevel + 1e-6) << level;
      EXPECT_LE(errors[level].toOriginal.max * mesh.diagonal(), 1.2 * toOriginal + 1e-6) << level;
      if (level > 0) mesh.coarsen(), mesh.fitTree();
    }
  }
}

TEST(MeasureLevels, roundingCountsWhereTheOriginalIsTheInput) {
  MeasureOptions options;
  options.countsRounding = true;
  const LevelError error = measured(cube(), options).front();
  EXPECT_EQ(error.toLevel.max, roundedUp(std::sqrt(0.75) / kDiagonal));
  EXPECT_EQ(error.toOriginal.max, error.toLevel.max);
  EXPECT_EQ(error.fields[0].max, roundedUp(0.5 / 120));
  EXPECT_EQ(error.fields[0].rms, roundedUp(std::sqrt(0.4 / 12) / 120));

  FusionHistory exact = cube();
  exact.fields[0].type = "int32";
  EXPECT_EQ(measured(exact, options).front().fields[0].max, 0) << "integers are kept exactly";
}

/// Values are rounded like the quantiser does, each on its own; places all over a cell are off by
/// what the figure says.
TEST(MeasureLevels, theRoundingsRmsIsThatOfRoundedValues) {
  SplitMix64 random(5);
  double sum = 0;
  constexpr int kCells = 20000;
  for (int i = 0; i < kCells; ++i) {
    std::array<double, 4> off{}, weights{};
    double total = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      off[c] = random.unit() - 0.5;
      weights[c] = -std::log(1 - random.unit());  // uniform in the tetrahedron once they sum to 1
      total += weights[c];
    }
    double error = 0;
    for (std::size_t c = 0; c < 4; ++c) error += off[c] * weights[c] / total;
    sum += error * error;
  }
  MeasureOptions options;
  options.countsRounding = true;
  const double told = measured(cube(), options).front().fields[0].rms * 120;
  EXPECT_NEAR(told, std::sqrt(sum / kCells), 0.03 * told);
}

TEST(MeasureLevels, aRowOfLevelsHasTheFiguresThatItWouldHaveAmongAll) {
  FusionHistory history = simplify(gridMesh(8, 4), {}).value();
  ASSERT_GT(history.levels, 2 * kRowLevels);
  const auto all = measured(history);
  const LevelErrors row = measureLevels(history, {}).value();
  ASSERT_EQ(row.size(), all.size());
  EXPECT_TRUE(row.front() && row.back());
  std::size_t known = 0;
  for (std::size_t level = 0; level < row.size(); ++level) {
    if (!row[level]) continue;
    ++known;
    EXPECT_EQ(row[level]->fields[0].rms, all[level].fields[0].rms) << level;
    EXPECT_EQ(row[level]->volumeLost, all[level].volumeLost) << level;
    EXPECT_EQ(row[level]->toLevel.mean, all[level].toLevel.mean) << level;
    EXPECT_EQ(row[level]->toOriginal.mean, all[level].toOriginal.mean) << level;
    EXPECT_NEAR(row[level]->boundaryDistance(), all[level].boundaryDistance(),
                1.1 * kFarthestTolerance * all[level].boundaryDistance())
        << level;
  }
  EXPECT_GT(known, kRowLevels / 2);
  EXPECT_LE(known, kRowLevels + 1);
}

TEST(MeasureLevels, levelsThatAreAskedForAreMeasured) {
  FusionHistory history = simplify(gridMesh(6, 4), {}).value();
  MeasureOptions options;
  options.levels.assign(history.levels + std::size_t{1}, 0);
  options.levels[3] = options.levels[7] = 1;
  const LevelErrors errors = measureLevels(history, options).value();
  for (std::size_t level = 0; level < errors.size(); ++level)
    EXPECT_EQ(errors[level].has_value(),
              level == 0 || level == 3 || level == 7 || level + 1 == errors.size())
        << level;
}

TEST(MeasureLevels, theErrorOfALabelIsTheShareOfTheVolumeThatIsWrong) {
  LatticeMesh mesh = gridMesh(8, 4);
  mesh.fields.push_back({"Half", 1, "int32", "cell", 1, 1, {0}, {0, 1}});
  std::vector<std::int32_t>& half = mesh.values.emplace_back();
  for (const Tetrahedron& t : mesh.tetrahedra)
    half.push_back(std::ranges::all_of(t, [&](VertexId v) { return mesh.points[v][0] >= 256; }));
  FusionOptions fusion;
  fusion.targetRatio = 0.2;
  const auto errorsBy = [&](const FusionOptions& options, const MeasureOptions& measuring) {
    FusionHistory history = simplify(mesh, options).value();
    return measureLevels(history, measuring).value().front()->fields.back();
  };
  MeasureOptions asLabel;
  asLabel.labels = {static_cast<std::uint32_t>(mesh.fields.size() - 1)};
  const FieldError number = errorsBy(fusion, {}), label = errorsBy(fusion, asLabel);
  EXPECT_GT(label.rms, 0.02);
  EXPECT_NEAR(label.rms, number.rms * number.rms, 0.01 * label.rms);
  EXPECT_EQ(label.max, 1);
  fusion.cost.labels = {{mesh.fields.size() - 1, 1000}};
  EXPECT_LT(errorsBy(fusion, asLabel).rms, label.rms / 4) << "interfaces count";
  fusion.cost.labels[0].weight = 0;
  EXPECT_EQ(errorsBy(fusion, asLabel).rms, label.rms);
  asLabel.base = BaseRule{.error = 1, .labelError = label.rms / 2};
  EXPECT_LE(errorsBy(fusion, asLabel).rms, label.rms / 2);
}

TEST(MeasureLevels, theRuleKeepsTheVolumeOfEachLabel) {
  // the corner of a cube, an eighth of its volume, which goes over to the rest
  FusionHistory history = simplify(gridMesh(8, 4), {}).value();
  history.fields = {{"Corner", 1, "int32", "cell", 1, 1, {0}, {0, 1}}};
  history.values = {{}};
  for (const auto& cell : history.cells) {
    if (cell[3] == kGhost) break;
    const LatticePoint& p = history.points[cell[0]];
    history.values[0].push_back(p[0] > 200 && p[1] > 200 && p[2] > 200);
  }
  HistoryLevels levels(history);
  levels.moveTo(levels.finest());
  const LabelVolumes volumes(history, {0});
  EXPECT_EQ(volumes.worst(), 0);
  levels.moveTo(0);
  EXPECT_GT(volumes.worst(), 0.1);
  EXPECT_EQ(LabelVolumes(history, {}).worst(), 0);
}

/// A corner goes in, its opposite out: a twelfth of the volume each.
TEST(MeasureLevels, whatIsLostAndWhatIsGainedDoNotCancelEachOtherOut) {
  FusionHistory h = cube();
  displace(h, 1, {90, 0, 0}, 0);
  displace(h, 6, {0, 150, 150}, 120);
  const LevelError error = measured(h)[0];
  EXPECT_NEAR(error.volumeLost, 1.0 / 12, 0.01);
  EXPECT_NEAR(error.volumeGained, 1.0 / 12, 0.01);
  EXPECT_NEAR(error.volumeLost, error.volumeGained, 1e-6);
}

TEST(MeasureLevels, aBoundEndsTheHistoryBeforeTheLevelThatPassesIt) {
  auto history = simplify(gridMesh(7, 2), {});
  ASSERT_TRUE(history);
  const FusionHistory whole = *history;
  const auto errors = measured(whole);
  const std::size_t wanted = errors.size() / 2;

  MeasureOptions options;
  options.levels.assign(errors.size(), 1);
  options.bounds.fields = {{"Swirl", errors[wanted].fields[1].rms}};
  const auto kept = measureLevels(*history, options);
  ASSERT_TRUE(kept);
  ASSERT_EQ(kept->size(), history->levels + 1u);
  ASSERT_LT(kept->size(), errors.size());
  EXPECT_EQ(kept->front()->fields[1].rms, errors[errors.size() - kept->size()].fields[1].rms);
  EXPECT_GT(errors[errors.size() - kept->size() - 1].fields[1].rms, errors[wanted].fields[1].rms)
      << "a level more would have kept the bound";
  EXPECT_EQ(testing::meshOfHistory(*history, 0).tetrahedra,
            testing::meshOfHistory(whole, static_cast<std::uint32_t>(errors.size() - kept->size()))
                .tetrahedra);

  FusionHistory again = whole;
  options.bounds = {};
  options.bounds.boundary = 0;
  const auto exact = measureLevels(again, options);
  ASSERT_TRUE(exact);
  for (const auto& error : *exact) EXPECT_EQ(error ? error->boundaryDistance() : 0, 0);
}

struct Base {
  std::size_t cells;
  LevelError error;
};
/// The base mesh that a rule chooses among all levels.
Base baseBy(FusionHistory history, const BaseRule& rule) {
  MeasureOptions options;
  options.levels.assign(history.levels + std::size_t{1}, 1);
  options.base = rule;
  const auto errors = measureLevels(history, options);
  EXPECT_TRUE(errors);
  return {testing::meshOfHistory(history, 0).tetrahedra.size(), errors->front().value()};
}

TEST(MeasureLevels, aRuleChoosesTheCoarsestLevelThatIsNear) {
  FusionOptions fusion;
  fusion.envelopeTolerance = 0;
  const FusionHistory history =
      simplify(gridMesh(7, 2, [](int i, int j, int) { return i != 3 || j < 2; }), fusion).value();
  const auto errors = measured(history);
  const auto isNear = [&](double error) {
    return [error, least = errors.back()](const LevelError& level) {
      return level.boundaryDistance() <= error && level.volumeLost <= 2 * error &&
             std::ranges::equal(level.fields, least.fields, [&](const auto& its, const auto& own) {
               return its.rms <= std::max(2 * error, own.rms);
             });
    };
  };
  for (const double error : {0.0, 0.01, 0.05}) {
    const auto first = std::ranges::find_if_not(errors.rbegin(), errors.rend(), isNear(error));
    ASSERT_TRUE(first != errors.rbegin() && first != errors.rend()) << error;
    EXPECT_TRUE(
        same(baseBy(history, {.error = error, .maxFieldShare = 1}).error, *std::prev(first)))
        << error;
  }
}

TEST(MeasureLevels, aRuleHeedsFieldsUntilTheBaseCostsTooMuch) {
  const FusionHistory history = simplify(gridMesh(7, 2), {}).value();
  const auto errors = measured(history);
  const auto rms = [](const LevelError& level) {
    return std::ranges::max(level.fields, {}, &FieldError::rms).rms;
  };
  const double error = rms(errors[errors.size() / 2]) / 2;
  const auto first = std::ranges::find_if(
      errors.rbegin(), errors.rend(), [&](const auto& level) { return rms(level) > 2 * error; });
  ASSERT_TRUE(first != errors.rend());
  BaseRule rule{.error = error, .maxFieldShare = 1};
  const Base near = baseBy(history, rule);
  EXPECT_TRUE(same(near.error, *std::prev(first)));

  FusionHistory ofIntegers = history;
  for (FieldInfo& field : ofIntegers.fields) field.type = "int32";
  EXPECT_LT(baseBy(ofIntegers, rule).cells, near.cells) << "they may be labels";
  const std::size_t without =
      baseBy(history, {.error = error, .maxFieldBytes = 0, .maxFieldShare = 1}).cells;
  EXPECT_LT(without, near.cells);

  const double all = static_cast<double>(
                   testing::meshOfHistory(history, history.levels).tetrahedra.size()),
               most = static_cast<double>(without + near.cells) / 2;
  rule.maxFieldShare = most / all;
  const std::size_t limited = baseBy(history, rule).cells;
  EXPECT_LE(static_cast<double>(limited), most);
  EXPECT_GT(limited, without);
}

TEST(MeasureLevels, aRuleTakesNoLevelAboveItsLimits) {
  const FusionHistory history = simplify(gridMesh(7, 2), {}).value();
  const std::uint32_t undone = history.levels / 2;
  const LatticeMesh level = testing::meshOfHistory(history, undone),
                    coarser = testing::meshOfHistory(history, undone - 1);
  const std::size_t cells = level.tetrahedra.size();
  ASSERT_GT(baseBy(history, {.error = 0}).cells, cells) << "the limits have nothing to do";
  EXPECT_EQ(baseBy(history, {.error = 0, .maxCells = cells + 1}).cells, cells);
  EXPECT_EQ(baseBy(history, {.error = 0, .maxCells = cells}).cells, cells);
  EXPECT_EQ(baseBy(history, {.error = 0, .maxCells = cells - 1}).cells, coarser.tetrahedra.size());

  std::size_t components = 0;
  for (const FieldInfo& field : history.fields) components += field.components;
  std::vector<VertexId> used;
  for (const Tetrahedron& t : level.tetrahedra) used.insert(used.end(), t.begin(), t.end());
  std::ranges::sort(used);
  used.erase(std::ranges::unique(used).begin(), used.end());
  const std::size_t bytes = baseBytesOf(used.size(), components);
  EXPECT_EQ(baseBy(history, {.error = 0, .maxBytes = bytes + 1}).cells, cells);
  EXPECT_EQ(baseBy(history, {.error = 0, .maxBytes = bytes}).cells, cells);
  EXPECT_LT(baseBy(history, {.error = 0, .maxBytes = bytes - 1}).cells, cells);
}

TEST(MeasureLevels, aBoundOfAFieldThatIsNotThereIsAnError) {
  FusionHistory h = cube();
  MeasureOptions options;
  options.bounds.fields = {{"Warmth", 0.1}};
  const auto result = measureLevels(h, options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kNotFound);
  EXPECT_NE(result.error().message.find("Warmth"), std::string::npos);
}

}  // namespace
}  // namespace qtet
