#include "simplify/fuse/qtetfusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>

#include "codec/mesh/boundary.h"
#include "codec/mesh/predicates.h"
#include "simplify/clean/quantise.h"
#include "simplify/clean/verify.h"
#include "simplify/mesh/fusion_mesh.h"
#include "simplify/samples/samples.h"
#include "tests/support/allocation_meter.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

using testing::eulerCharacteristics;
using testing::gridMesh;
using testing::meshOfHistory;
using testing::whatIsWrongWith;
using testing::withoutMemoryInOthers;

// Every boundary point of the finer mesh's solid contains the coarser one's: checked on the cells'
// corners, which suffices for volumes.
double volumeOf(const LatticeMesh& mesh) {
  double sum = 0;
  for (const Tetrahedron& t : mesh.tetrahedra)
    sum += static_cast<double>(
        volume6(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]));
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
  options.envelopeTolerance = 0;
  const auto history = simplify(mesh, options);
  ASSERT_TRUE(history) << history.error().text();
  const auto chi = eulerCharacteristics(mesh);
  double volume = 0;
  for (std::uint32_t undone = 0; undone <= history->levels; ++undone) {
    const LatticeMesh level = meshOfHistory(*history, undone);
    ASSERT_EQ(whatIsWrongWith(level), "") << "level " << undone;
    ASSERT_EQ(eulerCharacteristics(level), chi) << "level " << undone;
    EXPECT_GE(volumeOf(level), volume)
        << "level " << undone << " is no superset of the coarser one";
    volume = volumeOf(level);
  }
  EXPECT_EQ(volume, volumeOf(mesh));
  const LatticeMesh base = meshOfHistory(*history, 0);
  EXPECT_LT(base.tetrahedra.size(), mesh.tetrahedra.size() / 10);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, Fused,
    ::testing::Values(Case{"solid", [](int, int, int) { return true; }},
                      Case{"tunnel", [](int i, int j, int) { return i != 3 || j != 2; }},
                      Case{"void", [](int i, int j, int k) { return i != 2 || j != 3 || k != 2; }},
                      Case{"twoParts", [](int i, int, int) { return i != 3; }}),
    [](const auto& shape) { return std::string(shape.param.name); });

TEST(Fused, levelsAreIndependentSets) {
  const auto history = simplify(gridMesh(6, 5), {});
  ASSERT_TRUE(history);
  std::vector<std::uint32_t> lastLevel(history->cells.size(), ~0u);
  for (const Fusion& f : history->fusions)
    for (std::uint32_t i = 0; i < f.affectedCount + f.deletedCount; ++i) {
      const std::uint32_t cell = i < f.affectedCount
                                     ? history->affectedCells[f.firstAffected + i]
                                     : history->deletedCells[f.firstDeleted + i - f.affectedCount];
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
    const double left = static_cast<double>(meshOfHistory(*history, 0).tetrahedra.size()) /
                        static_cast<double>(mesh.tetrahedra.size());
    EXPECT_LE(left, ratio);
    EXPECT_GT(left, ratio - 0.02) << "the target is overshot by more than one fusion";
  }
}

/// The cells of one region and their boundary.
LatticeMesh regionOf(const LatticeMesh& mesh, std::size_t field, std::int32_t region) {
  LatticeMesh out;
  out.points = mesh.points;
  for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
    if (mesh.values[field][c] == region) out.tetrahedra.push_back(mesh.tetrahedra[c]);
  out.boundary = boundaryOf(out.tetrahedra);
  return out;
}

/// A cube whose cells carry one of four regions: a core, a shell round it, and two halves outside.
LatticeMesh layeredCube(std::uint32_t seed) {
  LatticeMesh mesh = gridMesh(8, seed);
  mesh.fields.push_back({"Tissue", 1, "int32", "cell", 3, 1, {0}, {0, 3}});
  mesh.values.emplace_back();
  for (const Tetrahedron& t : mesh.tetrahedra) {
    LatticePoint sum{};
    for (const VertexId v : t)
      for (std::size_t a = 0; a < 3; ++a) sum[a] += mesh.points[v][a];
    std::int32_t farthest = 0;
    for (const std::int32_t x : sum) farthest = std::max(farthest, std::abs(x / 4 - 256));
    mesh.values.back().push_back(farthest < 64 ? 0 : farthest < 160 ? 1 : sum[0] < 1024 ? 2 : 3);
  }
  return mesh;
}

TEST(Fused, regionsAndTheirInterfacesKeepTheirTopology) {
  const LatticeMesh mesh = layeredCube(5);
  FusionOptions options;
  options.targetRatio = 0;
  options.regionField = 2;
  const auto history = simplify(mesh, options);
  ASSERT_TRUE(history) << history.error().text();
  const auto shape = [&](const LatticeMesh& level, std::vector<std::int32_t> regions) {
    LatticeMesh part;
    part.points = level.points;
    for (const std::int32_t r : regions) {
      const LatticeMesh one = regionOf(level, 2, r);
      part.tetrahedra.insert(part.tetrahedra.end(), one.tetrahedra.begin(), one.tetrahedra.end());
    }
    part.boundary = boundaryOf(part.tetrahedra);
    return eulerCharacteristics(part);
  };
  // Each region alone, and each pair as one: their interface's characteristic is the difference.
  std::vector<std::vector<std::int32_t>> sets;
  for (std::int32_t a = 0; a < 4; ++a)
    for (std::int32_t b = a; b < 4; ++b)
      sets.push_back(a == b ? std::vector{a} : std::vector{a, b});
  for (std::uint32_t undone = 0; undone <= history->levels; undone += 3) {
    const LatticeMesh level = meshOfHistory(*history, undone);
    ASSERT_EQ(whatIsWrongWith(level), "");
    for (const auto& set : sets)
      ASSERT_EQ(shape(level, set), shape(mesh, set))
          << "level " << undone << ", region " << set.front() << " with " << set.back();
  }
  EXPECT_LT(meshOfHistory(*history, 0).tetrahedra.size(), mesh.tetrahedra.size() / 8)
      << "regions must not stop the simplification";

  options.regionField.reset();
  const auto without = simplify(mesh, options);
  ASSERT_TRUE(without);
  bool changed = false;
  for (const auto& set : sets)
    changed |= shape(meshOfHistory(*without, 0), set) != shape(mesh, set);
  EXPECT_TRUE(changed) << "this mesh would not show it if regions were ignored";
}

TEST(Fused, withoutAWordTheEnvelopeGivesWay) {
  const LatticeMesh mesh = gridMesh(6, 3, [](int i, int j, int) { return i < 2 || j < 2; });
  FusionOptions usual, given, none;
  given.envelopeTolerance = kEnvelopeTolerance, none.envelopeTolerance = 0;
  const auto pointsOf = [&](const FusionOptions& options) {
    return simplify(mesh, options).value().points;
  };
  EXPECT_EQ(pointsOf(usual), pointsOf(given));
  EXPECT_NE(pointsOf(usual), pointsOf(none));
}

TEST(Fused, theEnvelopeGivesWayByItsToleranceAndNoMore) {
  // A cylinder-like notch makes the boundary concave and convex; the outside distance is measured
  // by brute force, which shares nothing with the bound.
  const LatticeMesh mesh = gridMesh(7, 3, [](int i, int j, int) {
    return (i - 3) * (i - 3) + (j - 3) * (j - 3) <= 10 && (i != 3 || j != 3);
  });
  const double diagonal = std::sqrt(3.0) * 7 * 64;
  double farthest[2]{};
  for (const double tolerance : {0.0, 0.01}) {
    FusionOptions options;
    options.targetRatio = 0.05;
    options.envelopeTolerance = tolerance;
    // other vertices stay on the prey's edges and seldom leave the solid
    options.placement = PlacementRule::kOptimal;
    const auto history = simplify(mesh, options);
    ASSERT_TRUE(history);
    const LatticeMesh base = meshOfHistory(*history, 0);
    ASSERT_EQ(whatIsWrongWith(base), "");
    EXPECT_EQ(eulerCharacteristics(base), eulerCharacteristics(mesh));
    for (const LatticePoint& p : history->points)
      for (const std::int32_t x : p)
        ASSERT_TRUE(x >= 0 && x < 1 << mesh.lattice.bits) << "off the lattice";
    double& most = farthest[tolerance > 0];
    for (std::uint32_t level = 0; level <= history->levels; ++level) {
      const LatticeMesh coarse = meshOfHistory(*history, level);
      for (const Triangle& t : coarse.boundary)
        for (const VertexId v : t)
          most = std::max(most, testing::distanceOutside(mesh, coarse.points[v]));
    }
    EXPECT_LE(most, tolerance * diagonal + 1e-9);
  }
  EXPECT_GT(farthest[1], 0.5) << "the room was used: half a step of 7.8";
}

// A centre that every surface vertex is joined to, numbered last: more neighbours than any star
// that is looked at may have.
TEST(Fused, aHubOfThousandsOfCellsIsLeftAlone) {
  LatticeMesh mesh;
  mesh.lattice.bits = 16;
  constexpr VertexId kRing = 900;
  const auto spoke = [](VertexId i) {
    // a convex polygon from a parabola's points, closed by a far one
    const double x = 2.0 * i / kRing - 1;
    return LatticePoint{static_cast<std::int32_t>(30000 + 30000 * x),
                        static_cast<std::int32_t>(60000 * x * x), 0};
  };
  for (VertexId i = 0; i < kRing; ++i) {
    LatticePoint p = spoke(i);
    p[2] = 100;
    mesh.points.push_back(p);
  }
  const VertexId top = kRing, centre = kRing + 1;
  mesh.points.push_back({30000, 40000, 3000});
  mesh.points.push_back({30000, 40000, 200});
  for (VertexId i = 0; i + 1 < kRing; ++i) mesh.tetrahedra.push_back({i, i + 1, centre, top});
  for (Tetrahedron& t : mesh.tetrahedra)
    if (orientation(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) < 0)
      std::swap(t[2], t[3]);
  mesh.boundary = boundaryOf(mesh.tetrahedra);
  const auto history = simplify(mesh, {});
  ASSERT_TRUE(history);
}

TEST(Fused, finestLatticesWithoutFieldsAreFusedAsFar) {
  LatticeMesh mesh = gridMesh(6, 2);
  mesh.fields.clear();
  mesh.values.clear();
  const auto coarse = simplify(mesh, {});
  LatticeMesh fine = mesh;
  fine.lattice.bits = 28;
  for (LatticePoint& p : fine.points)
    for (std::int32_t& x : p) x <<= 19;
  const auto far = simplify(fine, {});
  ASSERT_TRUE(coarse && far);
  EXPECT_NEAR(static_cast<double>(meshOfHistory(*far, 0).tetrahedra.size()),
              static_cast<double>(meshOfHistory(*coarse, 0).tetrahedra.size()), 16);
}

TEST(Fused, theBaseMeshHasAHundredthOfTheCellsOrAsManyAsAreAskedFor) {
  FusionOptions options;
  EXPECT_EQ(baseCellsOf(options, 200'000), 2'000u);
  EXPECT_EQ(baseCellsOf(options, 61'600'000), 30'000u) << "a first picture waits for all of them";
  options.targetRatio = 0.01;
  EXPECT_EQ(baseCellsOf(options, 61'600'000), 616'000u);
  options = {};
  options.baseCells = 700;
  EXPECT_EQ(baseCellsOf(options, 61'600'000), 700u);
  const LatticeMesh mesh = gridMesh(8, 3);
  const auto history = simplify(mesh, options);
  ASSERT_TRUE(history);
  const std::size_t base = meshOfHistory(*history, 0).tetrahedra.size();
  EXPECT_LE(base, 700u);
  EXPECT_GT(base, 650u);
}

/// A plate full of holes, each of which stays: what is left of it cannot become much less.
TEST(Fused, endsWhereLevelsBringNextToNothing) {
  const LatticeMesh mesh =
      gridMesh(12, 5, [](int x, int y, int z) { return z < 2 && (x % 2 == 0 || y % 2 == 0); });
  FusionOptions options;
  options.targetRatio = 0;
  const auto history = simplify(mesh, options);
  ASSERT_TRUE(history);
  std::vector<std::size_t> cells;
  for (std::uint32_t level = 0; level <= history->levels; ++level)
    cells.push_back(meshOfHistory(*history, level).tetrahedra.size());
  EXPECT_GT(cells.front(), 200u) << "25 holes";
  // Two passes may each end with eight levels of less than 2 %.
  std::size_t slow = 0;
  for (std::size_t i = 0; i + 1 < cells.size(); ++i)
    slow += static_cast<double>(cells[i + 1] - cells[i]) < 0.0025 * static_cast<double>(cells[i]);
  EXPECT_LE(slow, 16u) << cells.size() << " levels";
}

TEST(Fused, refusesWhatItCannotDo) {
  EXPECT_EQ(simplify({}, {}).error().code, ErrorCode::kBadInput);
  FusionOptions options;
  options.targetRatio = 0.5;
  options.baseCells = 100;
  EXPECT_EQ(simplify(gridMesh(2, 1), options).error().code, ErrorCode::kBadInput);
  options.baseCells.reset();
  options.targetRatio = 1.5;
  EXPECT_EQ(simplify(gridMesh(2, 1), options).error().code, ErrorCode::kBadInput);
  options = {};
  options.cost.fieldWeights = {1, -1};
  EXPECT_EQ(simplify(gridMesh(2, 1), options).error().code, ErrorCode::kBadInput);
  options.cost.fieldWeights = {1};
  EXPECT_EQ(simplify(gridMesh(2, 1), options).error().code, ErrorCode::kBadInput)
      << "one weight for two fields";
  options = {};
  options.regionField = 0;
  EXPECT_EQ(simplify(gridMesh(2, 1), options).error().code, ErrorCode::kBadInput)
      << "a point field is no field of regions";
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
    for (std::size_t i = 0; i < f.k; ++i)
      ASSERT_FALSE(f.prey[i] < mesh.points.size() && before.singular(f.prey[i]));
  EXPECT_EQ(eulerCharacteristics(meshOfHistory(*history, 0)), eulerCharacteristics(mesh));
}

void expectTheSameOfAnyNumberOfThreads(const LatticeMesh& mesh) {
  const auto one = simplify(mesh, {});
  ASSERT_TRUE(one);
  for (const int threads : {2, 5}) {
    FusionOptions options;
    options.threads = threads;
    const auto several = simplify(mesh, options);
    ASSERT_TRUE(several);
    testing::expectTheSame(*several, *one);
  }
}

TEST(Fused, theNumberOfThreadsDecidesNothing) {
  expectTheSameOfAnyNumberOfThreads(
      gridMesh(10, 4, [](int i, int j, int) { return i != 3 || j != 4; }));
}

// Where nearly all is boundary the envelope makes most fusions dearer than their keys, so that
// owners come back to the queue.
TEST(Fused, theNumberOfThreadsDecidesNothingWhereAllIsBoundary) {
  for (std::uint32_t seed = 1; seed <= 2; ++seed) {
    expectTheSameOfAnyNumberOfThreads(gridMesh(40, seed, [](int, int, int k) { return k < 1; }));
    expectTheSameOfAnyNumberOfThreads(
        gridMesh(24, seed, [](int i, int j, int k) { return i % 4 < 3 && j % 4 < 3 && k < 4; }));
  }
}

TEST(Fused, aThreadThatFindsNoMemoryKeepsNobodyWaiting) {
  const LatticeMesh mesh = gridMesh(6, 1);
  FusionOptions options;
  options.threads = 3;
  for (std::int64_t n = 0; n < 200; n += 1 + n / 8) {
    try {
      // where the others came too late for so many
      withoutMemoryInOthers(n, [&] { EXPECT_TRUE(simplify(mesh, options)); });
    } catch (const std::bad_alloc&) {
    }
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
  for (const Fusion& f : history->fusions)
    EXPECT_NEAR(history->values[0][f.fused], value(history->points[f.fused]), 1)
        << "of values up to " << high;
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
