#include "simplify/qtetfusion.h"

#include <gtest/gtest.h>

#include "codec/predicates.h"
#include "simplify/fusion_mesh.h"
#include "simplify/fusion_test.h"
#include "simplify/quadric.h"
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

TEST(Quadric, isTheAreaWeightedSquaredDistanceOfEquationOne) {
  Quadric q;
  q.addTriangle({0, 0, 5}, {4, 0, 5}, {0, 2, 5}, 1);  // area 4 in the plane z = 5
  EXPECT_DOUBLE_EQ(q.at({7, -3, 5}), 0);
  EXPECT_DOUBLE_EQ(q.at({0, 0, 8}), 4 * 4 * 3 * 3);
  Quadric weighted;
  weighted.addTriangle({0, 0, 5}, {4, 0, 5}, {0, 2, 5}, 10);
  EXPECT_DOUBLE_EQ(weighted.at({0, 0, 8}), 100 * 4 * 4 * 3 * 3);
}

TEST(Quadric, itsMinimumIsWhereThreePlanesMeet) {
  Quadric q;
  q.addTriangle({2, 0, 0}, {2, 1, 0}, {2, 0, 1}, 1);
  q.addTriangle({0, 3, 0}, {1, 3, 0}, {0, 3, 1}, 1);
  EXPECT_FALSE(q.minimum()) << "two planes meet in a line: equation 6 has no one answer";
  q.addTriangle({0, 0, 4}, {1, 0, 4}, {0, 1, 4}, 1);
  const auto p = q.minimum();
  ASSERT_TRUE(p);
  EXPECT_NEAR((*p)[0], 2, 1e-9);
  EXPECT_NEAR((*p)[1], 3, 1e-9);
  EXPECT_NEAR((*p)[2], 4, 1e-9);
}

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

TEST(FusionTest, anEdgeBetweenTwoBoundariesIsNotFused) {
  // The wall between a void and the outside is one cube thick: every edge through it joins two boundary components.
  const LatticeMesh mesh = gridMesh(3, 1, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
  const FusionMesh live(mesh);
  FusionTest test(live);
  std::size_t edges = 0;
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const auto outer = [&](VertexId v) { return std::ranges::any_of(mesh.points[v], [](std::int32_t x) { return x == 0 || x == 192; }); };
        if (outer(t[i]) == outer(t[j])) continue;
        ++edges;
        EXPECT_FALSE(test.gather({2, {t[i], t[j], 0, 0}}) && test.keepsTopology());
      }
  EXPECT_GT(edges, 0u);
}

TEST(FusionTest, theEnvelopeIsClosedButNothingOutsideBelongsToIt) {
  const LatticeMesh mesh = gridMesh(2, 1);
  const FusionMesh live(mesh);
  FusionTest test(live);
  for (VertexId v = 0; v < mesh.points.size(); ++v) {
    if (mesh.points[v] != LatticePoint{0, 64, 64}) continue;
    const auto& cell = live.cell(live.star(v)[0]);
    const VertexId w = cell[0] == v ? cell[1] : cell[0];
    ASSERT_TRUE(test.gather({2, {v, w, 0, 0}}));
    EXPECT_TRUE(test.insideEnvelope({0, 64, 64})) << "on the boundary is inside";
    EXPECT_FALSE(test.insideEnvelope({-1, 64, 64}));
    LatticePoint projected{};
    ASSERT_TRUE(test.projectInside({-5.3, 60, 60}, projected));
    EXPECT_TRUE(test.insideEnvelope(projected));
    EXPECT_EQ(projected[0], 0);
  }
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
