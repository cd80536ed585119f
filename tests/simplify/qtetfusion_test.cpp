#include "simplify/qtetfusion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "codec/predicates.h"
#include "simplify/fusion_mesh.h"
#include "simplify/quantise.h"
#include "simplify/samples.h"
#include "simplify/verify.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::eulerCharacteristics;
using testing::gridMesh;
using testing::meshOfHistory;
using testing::whatIsWrongWith;

// Every boundary point of the finer mesh's solid contains the coarser one's: checked on the cells' corners, which suffices for volumes.
double volumeOf(const LatticeMesh& mesh) {
  double sum = 0;
  for (const Tetrahedron& t : mesh.tetrahedra) sum += static_cast<double>(volume6(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]));
  return sum / 6;
}

struct Case {
  const char* name;
  bool (*keep)(int, int, int);
};
void PrintTo(const Case& shape, std::ostream* out) { *out << shape.name; }

class Fused : public ::testing::TestWithParam<Case> {};

TEST_P(Fused, everyLevelIsValidInsideTheOneBeforeAndOfTheSameTopology) {
  const LatticeMesh mesh = gridMesh(6, 11, GetParam().keep);
  FusionOptions options;
  options.targetRatio = 0;
  const auto history = simplify(mesh, options);
  ASSERT_TRUE(history) << history.error().text();
  const auto chi = eulerCharacteristics(mesh);
  double volume = 0;
  for (std::uint32_t undone = 0; undone <= history->levels; ++undone) {
    const LatticeMesh level = meshOfHistory(*history, undone);
    ASSERT_EQ(whatIsWrongWith(level), "") << "level " << undone;
    ASSERT_EQ(eulerCharacteristics(level), chi) << "level " << undone;
    EXPECT_GE(volumeOf(level), volume) << "level " << undone << " is no superset of the coarser one";
    volume = volumeOf(level);
  }
  EXPECT_EQ(volume, volumeOf(mesh));
  const LatticeMesh base = meshOfHistory(*history, 0);
  EXPECT_LT(base.tetrahedra.size(), mesh.tetrahedra.size() / 10);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Fused,
                         ::testing::Values(Case{"solid", [](int, int, int) { return true; }}, Case{"tunnel", [](int i, int j, int) { return i != 3 || j != 2; }},
                                           Case{"void", [](int i, int j, int k) { return i != 2 || j != 3 || k != 2; }},
                                           Case{"twoParts", [](int i, int, int) { return i != 3; }}),
                         [](const auto& shape) { return std::string(shape.param.name); });

TEST(Fused, levelsAreIndependentSets) {
  const auto history = simplify(gridMesh(6, 5), {});
  ASSERT_TRUE(history);
  std::vector<std::uint32_t> lastLevel(history->cells.size(), ~0u);
  for (const Fusion& f : history->fusions)
    for (std::uint32_t i = 0; i < f.affectedCount + f.deletedCount; ++i) {
      const std::uint32_t cell = i < f.affectedCount ? history->affectedCells[f.firstAffected + i] : history->deletedCells[f.firstDeleted + i - f.affectedCount];
      ASSERT_NE(lastLevel[cell], f.level) << "two fusions of one level share a cell";
      lastLevel[cell] = f.level;
    }
}

TEST(Fused, usesTetrahedraTrianglesAndEdges) {
  const auto history = simplify(gridMesh(8, 3), {});
  ASSERT_TRUE(history);
  std::array<int, 5> count{};
  for (const Fusion& f : history->fusions) ++count[f.k];
  EXPECT_GT(count[2], 0);
  EXPECT_GT(count[3], 0);
  EXPECT_GT(count[4], 0);
}

TEST(Fused, stopsAtTheTarget) {
  const LatticeMesh mesh = gridMesh(8, 3);
  for (const double ratio : {1.0, 0.5, 0.1}) {
    FusionOptions options;
    options.targetRatio = ratio;
    const auto history = simplify(mesh, options);
    ASSERT_TRUE(history);
    const double left = static_cast<double>(meshOfHistory(*history, 0).tetrahedra.size()) / static_cast<double>(mesh.tetrahedra.size());
    EXPECT_LE(left, ratio);
    EXPECT_GT(left, ratio - 0.02) << "the target is overshot by more than one fusion";
  }
}

TEST(Fused, refusesWhatItCannotDo) {
  EXPECT_EQ(simplify({}, {}).error().code, ErrorCode::kBadInput);
  FusionOptions options;
  options.targetRatio = 1.5;
  EXPECT_EQ(simplify(gridMesh(2, 1), options).error().code, ErrorCode::kBadInput);
}

TEST(Fused, whatIsSingularStays) {
  // Two blocks that share one edge: its vertices are singular and must all be there at the end.
  const LatticeMesh mesh = gridMesh(4, 6, [](int i, int j, int) { return (i < 2) == (j < 2); });
  const FusionMesh before(mesh);
  std::size_t singular = 0;
  for (VertexId v = 0; v < mesh.points.size(); ++v) singular += before.singular(v);
  EXPECT_EQ(singular, 5u);
  FusionOptions options;
  options.targetRatio = 0;
  const auto history = simplify(mesh, options);
  ASSERT_TRUE(history);
  for (const Fusion& f : history->fusions)
    for (std::size_t i = 0; i < f.k; ++i) ASSERT_FALSE(f.prey[i] < mesh.points.size() && before.singular(f.prey[i]));
  EXPECT_EQ(eulerCharacteristics(meshOfHistory(*history, 0)), eulerCharacteristics(mesh));
}

TEST(Fused, theNumberOfThreadsDecidesNothing) {
  const LatticeMesh mesh = gridMesh(10, 4, [](int i, int j, int) { return i != 3 || j != 4; });
  const auto one = simplify(mesh, {});
  ASSERT_TRUE(one);
  for (const int threads : {2, 5}) {
    FusionOptions options;
    options.threads = threads;
    const auto several = simplify(mesh, options);
    ASSERT_TRUE(several);
    EXPECT_EQ(several->points, one->points);
    EXPECT_EQ(several->values, one->values);
    EXPECT_EQ(several->cells, one->cells);
    EXPECT_EQ(several->affectedCells, one->affectedCells);
    EXPECT_EQ(several->affectedLabels, one->affectedLabels);
    EXPECT_EQ(several->levels, one->levels);
  }
}

TEST(Fused, aFieldThatIsLinearCostsNothingAndStaysWhatItIs) {
  LatticeMesh mesh = gridMesh(8, 2);
  mesh.fields = {{"Linear", 1, "float32", "point", 16, 1, {0}, {0, 1}}};
  mesh.values.assign(1, {});
  const auto value = [](const LatticePoint& p) { return 3 * p[0] + 5 * p[1] + 7 * p[2]; };
  for (const LatticePoint& p : mesh.points) mesh.values[0].push_back(value(p));
  const auto [low, high] = std::ranges::minmax(mesh.values[0]);
  mesh.fields[0].range = {static_cast<double>(low), static_cast<double>(high)};
  const auto history = simplify(mesh, {});
  ASSERT_TRUE(history);
  ASSERT_LT(meshOfHistory(*history, 0).tetrahedra.size(), mesh.tetrahedra.size() / 20);
  for (const Fusion& f : history->fusions) EXPECT_NEAR(history->values[0][f.fused], value(history->points[f.fused]), 1) << "of values up to " << high;
}

TEST(Samples, bothSamplesComeBackFromTheirHistory) {
  for (const char* name : {"box", "fin"}) {
    const auto sample = makeSample(name);
    ASSERT_TRUE(sample);
    const auto quantised = quantise(*sample);
    ASSERT_TRUE(quantised) << quantised.error().text();
    const auto history = simplify(quantised->mesh, {});
    ASSERT_TRUE(history) << history.error().text();
    EXPECT_LE(meshOfHistory(*history, 0).tetrahedra.size(), quantised->mesh.tetrahedra.size() / 20);
    const auto same = sameMesh(meshOfHistory(*history, history->levels), quantised->mesh);
    EXPECT_TRUE(same) << name << ": " << same.error().text();
  }
}

}  // namespace
}  // namespace qtet
