// The parts of measuring: nearest points against brute force, samples against the averages that
// they must have.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "simplify/measure/measure_samples.h"
#include "simplify/mesh/split_mix64.h"
#include "simplify/mesh/triangle_tree.h"
#include "tests/support/meshes.h"

namespace qtet {
namespace {

constexpr std::array<Vector3, 3> kTriangle{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};

TEST(NearestOnTriangle, everyRegionHasItsPoint) {
  const auto squared = [](const Vector3& p) { return nearestOnTriangle(p, kTriangle).squared; };
  EXPECT_DOUBLE_EQ(squared({1, 1, 3}), 9);     // above the face
  EXPECT_DOUBLE_EQ(squared({-3, -4, 0}), 25);  // corner a
  EXPECT_DOUBLE_EQ(squared({7, -4, 0}), 25);   // corner b
  EXPECT_DOUBLE_EQ(squared({-4, 7, 0}), 25);   // corner c
  EXPECT_DOUBLE_EQ(squared({1, -2, 0}), 4);    // edge ab
  EXPECT_DOUBLE_EQ(squared({-2, 1, 0}), 4);    // edge ac
  EXPECT_DOUBLE_EQ(squared({4, 4, 0}), 8);     // edge bc
  EXPECT_DOUBLE_EQ(squared({2, 1, 0}), 0);
}

TEST(NearestOnTriangle, weightsGiveTheNearestPoint) {
  const NearestPoint near = nearestOnTriangle({4, 4, 1}, kTriangle);
  const Vector3 at = blend(kTriangle, near.weights);
  EXPECT_DOUBLE_EQ(at[0], 2);
  EXPECT_DOUBLE_EQ(at[1], 2);
  EXPECT_DOUBLE_EQ(at[2], 0);
}

TEST(NearestOnTriangle, degenerateTrianglesAreSegmentsAndPoints) {
  EXPECT_DOUBLE_EQ(nearestOnTriangle({5, 3, 0}, {{{0, 0, 0}, {2, 0, 0}, {8, 0, 0}}}).squared, 9);
  EXPECT_DOUBLE_EQ(nearestOnTriangle({5, 3, 0}, {{{0, 0, 0}, {0, 0, 0}, {8, 0, 0}}}).squared, 9);
  EXPECT_DOUBLE_EQ(nearestOnTriangle({5, 3, 0}, {{{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}}).squared, 9);
  EXPECT_DOUBLE_EQ(nearestOnTriangle({3, 4, 0}, {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}).squared, 25);
}

/// Triangles of a wild surface: any three of some points.
struct Soup {
  std::vector<LatticePoint> points;
  std::vector<TriangleTree::Cell> cells;
  std::vector<std::uint32_t> ids;
  SplitMix64 random{7};

  explicit Soup(std::uint32_t triangles) {
    for (int i = 0; i < 200; ++i) points.push_back(randomPoint());
    for (std::uint32_t i = 0; i < triangles; ++i)
      cells.push_back({vertex(), vertex(), vertex(), kGhost}), ids.push_back(i);
  }
  LatticePoint randomPoint() { return {coordinate(), coordinate(), coordinate()}; }
  std::int32_t coordinate() { return static_cast<std::int32_t>(random.next() % 1000); }
  VertexId vertex() { return static_cast<VertexId>(random.next() % points.size()); }
  [[nodiscard]] double bruteForce(const Vector3& p, const std::vector<std::uint8_t>& live) const {
    double best = HUGE_VAL;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (live[i])
        best = std::min(best, nearestOnTriangle(
                                  p, {toVector(points[cells[i][0]]), toVector(points[cells[i][1]]),
                                      toVector(points[cells[i][2]])})
                                  .squared);
    return best;
  }
};

TEST(TriangleTree, findsTheNearestAlsoAfterTheSurfaceHasMovedAndShrunk) {
  for (const std::uint32_t triangles : {1u, 2u, 3u, 100u}) {
    Soup soup(triangles);
    std::vector<std::uint8_t> live(triangles, 1);
    TriangleTree tree(soup.points, soup.cells, soup.ids);
    for (int round = 0; round < 5; ++round) {
      for (int i = 0; i < 100; ++i) {
        const Vector3 p = toVector(soup.randomPoint());
        NearestTriangle best;
        tree.nearest(p, best);
        EXPECT_EQ(best.point.squared, soup.bruteForce(p, live));
        NearestTriangle again;
        tree.tryTriangle(p, best.triangle, again);
        EXPECT_EQ(again.point.squared, best.point.squared) << "it is another triangle's distance";
      }
      for (auto& cell : soup.cells) cell[soup.random.next() % 3] = soup.vertex();
      if (triangles > 10) live[static_cast<std::size_t>(soup.random.next() % triangles)] = 0;
      tree.refit(live);
    }
  }
}

/// The boundary of a fan of `n` tetrahedra: two cones of long thin triangles with one rim.
Soup fan(std::uint32_t n) {
  const LatticeMesh mesh = testing::fanMesh(n);
  Soup out(0);
  out.points = mesh.points;
  for (const Triangle& t : mesh.boundary) out.cells.push_back({t[0], t[1], t[2], kGhost});
  out.ids.resize(out.cells.size());
  std::iota(out.ids.begin(), out.ids.end(), 0u);
  return out;
}

TEST(TriangleTree, aFanOfThinTrianglesIsSearchedInPart) {
  Soup soup = fan(20000);
  std::vector<std::uint8_t> live(soup.cells.size(), 1);
  TriangleTree tree(soup.points, soup.cells, soup.ids);
  for (int round = 0; round < 2; ++round) {
    const std::vector<ErrorSample> places =
        samplesOnSurface(soup.points, soup.cells, soup.ids, 200, 3);
    std::size_t looked = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vector3 p = places[i].at + Vector3{0, 0, i % 2 == 0 ? 0.0 : 2000.0};
      NearestTriangle best;
      looked += tree.nearest(p, best);
      if (i % 10 == 0) {
        EXPECT_EQ(best.point.squared, soup.bruteForce(p, live));
      }
    }
    EXPECT_LT(looked / places.size(), 300u) << "nodes a search";
    for (std::size_t i = 0; i < live.size(); i += 3) live[i] = 0;
    for (LatticePoint& point : soup.points) point[0] += point[1] / 4;
    tree.refit(live);
    std::erase_if(soup.ids, [&](std::uint32_t id) { return live[id] == 0; });
  }
}

TEST(TriangleTree, aBetterGuessStays) {
  Soup soup(50);
  const TriangleTree tree(soup.points, soup.cells, soup.ids);
  NearestTriangle best{99, {0, {}}};
  tree.nearest({500, 500, 500}, best);
  EXPECT_EQ(best.triangle, 99u);
}

TEST(SplitMix64, isTheOneThatIsPublished) {
  SplitMix64 random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317u);
  EXPECT_EQ(random.next(), 3203168211198807973u);
}

TEST(MeasureSamples, lieInTheirCellsAndFillTheVolume) {
  const LatticeMesh mesh = testing::gridMesh(4, 1);
  const auto samples = samplesInVolume(mesh.points, mesh.tetrahedra, 20000, 5);
  ASSERT_EQ(samples.size(), 20000u);
  Vector3 mean{};
  double squares = 0;
  for (const ErrorSample& s : samples) {
    std::array<Vector3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i)
      corners[i] = toVector(mesh.points[mesh.tetrahedra[s.cell][i]]);
    const Vector3 apart = s.at - blend(corners, s.weights);
    EXPECT_LT(dot(apart, apart), 1e-18);
    for (const double w : s.weights) EXPECT_GE(w, -1e-12);
    for (std::size_t k = 0; k < 3; ++k) mean[k] += s.at[k] / 20000;
    squares += (s.at[0] - 128) * (s.at[0] - 128) / 20000;
  }
  for (const double m : mean) EXPECT_NEAR(m, 128, 1);  // a cube of 256 steps
  EXPECT_NEAR(squares, 256.0 * 256 / 12, 60);          // the variance of what is uniform
}

TEST(MeasureSamples, areUniformInOneTetrahedronAndOneTriangle) {
  const std::vector<LatticePoint> points = {{0, 0, 0}, {100, 0, 0}, {0, 100, 0}, {0, 0, 100}};
  const std::vector<std::array<VertexId, 4>> cells = {{0, 1, 2, 3}};
  std::array<double, 4> squares{};
  for (const ErrorSample& s : samplesInVolume(points, cells, 40000, 9))
    for (std::size_t i = 0; i < 4; ++i) squares[i] += s.weights[i] * s.weights[i] / 40000;
  // of the Dirichlet distribution: 2 / (4 * 5)
  for (const double s : squares) EXPECT_NEAR(s, 0.1, 0.002);
  squares = {};
  const std::vector<std::uint32_t> ids = {0};
  for (const ErrorSample& s : samplesOnSurface(points, cells, ids, 40000, 9))
    for (std::size_t i = 0; i < 4; ++i) squares[i] += s.weights[i] * s.weights[i] / 40000;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(squares[i], 1.0 / 6, 0.003);
  EXPECT_EQ(squares[3], 0);
}

TEST(MeasureSamples, cellsWithoutMeasureHaveNone) {
  const std::vector<LatticePoint> points = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {9, 9, 0}, {0, 0, 9}};
  const std::vector<std::array<VertexId, 4>> cells = {
      {0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, kGhost}};
  for (const ErrorSample& s : samplesInVolume(points, cells, 100, 1)) EXPECT_EQ(s.cell, 1u);
  EXPECT_TRUE(samplesInVolume(points, std::span(cells).first(1), 100, 1).empty());
}

}  // namespace
}  // namespace qtet
