// Heights of closed surfaces over flat pieces, against nearest triangles at many places.
#include "simplify/measure/surface_over.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace qtet {
namespace {

struct Surface {
  std::vector<LatticePoint> points;
  std::vector<TriangleTree::Cell> triangles;

  [[nodiscard]] TriangleTree tree() const {
    std::vector<std::uint32_t> ids(triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    return {points, triangles, std::move(ids)};
  }
};

// A random number of 0..1.
double share(std::mt19937& random) { return static_cast<double>(random() % 1001) / 1000; }

constexpr std::int32_t kSize = 1 << 16;

// An octahedron whose triangles are quartered `times`. Its points are blown up to a sphere of a
// radius that differs by `bumps` at most from place to place.
Surface sphere(int times, double bumps) {
  Surface out{{}, {}};
  std::mt19937 random(5);
  const auto point = [&](Vector3 at) {
    const double length = std::sqrt(dot(at, at));
    const double radius = kSize * (1 + bumps * (share(random) - 0.5));
    LatticePoint p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = static_cast<std::int32_t>(std::lround(2 * kSize + at[k] * radius / length));
    out.points.push_back(p);
    return static_cast<VertexId>(out.points.size() - 1);
  };
  for (const Vector3& at :
       {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}})
    (void)point(at);
  for (const auto& t : {TriangleTree::Cell{0, 1, 2},
                        {1, 3, 2},
                        {3, 4, 2},
                        {4, 0, 2},
                        {1, 0, 5},
                        {3, 1, 5},
                        {4, 3, 5},
                        {0, 4, 5}})
    out.triangles.push_back({t[0], t[1], t[2], kGhost});
  for (; times > 0; --times) {
    std::map<std::pair<VertexId, VertexId>, VertexId> middles;
    const auto middle = [&](VertexId a, VertexId b) {
      const auto [it, isNew] = middles.try_emplace(std::minmax(a, b), 0);
      if (isNew) {
        Vector3 at{};
        for (std::size_t k = 0; k < 3; ++k)
          at[k] = out.points[a][k] + out.points[b][k] - 4.0 * kSize;
        it->second = point(at);
      }
      return it->second;
    };
    std::vector<TriangleTree::Cell> finer;
    for (const auto& [a, b, c, ghost] : out.triangles) {
      const VertexId ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t : {TriangleTree::Cell{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        finer.push_back({t[0], t[1], t[2], ghost});
    }
    out.triangles = std::move(finer);
  }
  return out;
}

Vector3 normalOf(const Corners& t) {
  const Vector3 n = cross(t[1] - t[0], t[2] - t[0]);
  return 1 / std::sqrt(dot(n, n)) * n;
}

// Shrunk to a share of its size, about its middle.
Corners shrunk(const Corners& t, double share) {
  const Vector3 middle = 1 / 3.0 * (t[0] + t[1] + t[2]);
  Corners out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = middle + share * (t[i] - middle);
  return out;
}

SurfaceOver over(const TriangleTree& tree, const Corners& t, double most) {
  return surfaceOver(tree, t, normalOf(t), most);
}

// The largest of the distances at places of the triangle.
double farthest(const TriangleTree& tree, const Corners& t) {
  constexpr int kSteps = 12;
  double out = 0;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j) {
      NearestTriangle nearest;
      tree.nearest(t[0] + 1.0 / kSteps * (i * (t[1] - t[0]) + j * (t[2] - t[0])), nearest);
      out = std::max(out, std::sqrt(nearest.point.squared));
    }
  return out;
}

TEST(SurfaceOver, noPlaceIsFurtherThanTheHeight) {
  const Surface surface = sphere(4, 0.02);
  const TriangleTree tree = surface.tree();
  std::mt19937 random(7);
  const auto somewhere = [&](double reach) { return reach * (2 * share(random) - 1); };
  std::size_t proven = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Corners on =
        tree.corners(static_cast<std::uint32_t>(random() % surface.triangles.size()));
    const double size = kSize * 0.02 * (1 << trial % 4);
    Corners t;
    for (Vector3& corner : t)
      corner = on[0] + Vector3{somewhere(size), somewhere(size), somewhere(size)};
    const double most = size * (1 + trial % 3);
    const SurfaceOver found = over(tree, t, most);
    if (std::isinf(found.height)) continue;
    ++proven;
    EXPECT_LE(farthest(tree, t), found.height);
    EXPECT_LE(found.height, most);
    EXPECT_GT(found.cover.count, 0);
  }
  EXPECT_GT(proven, 50u) << "something is proven";
  EXPECT_LT(proven, 350u) << "and something is not";
}

TEST(SurfaceOver, ofAFlatSurfaceItIsTheFarthestCornersDistance) {
  const Surface surface = sphere(0, 0);
  const TriangleTree tree = surface.tree();
  const Corners face = tree.corners(0);
  const Vector3 n = normalOf(face);
  Corners t = shrunk(face, 0.3);
  for (std::size_t i = 0; i < 3; ++i) t[i] = t[i] + (100.0 * static_cast<double>(i)) * n;
  const SurfaceOver found = over(tree, t, 1000);
  EXPECT_NEAR(found.height, 200, 1);
  EXPECT_EQ(found.triangle, 0u);
  EXPECT_EQ(found.cover.count, 1);
}

TEST(SurfaceOver, whereTheSurfaceEndsNothingIsProven) {
  const Surface surface = sphere(0, 0);
  const TriangleTree tree = surface.tree();
  const Corners face = tree.corners(0);
  const Vector3 n = normalOf(face), middle = 1 / 3.0 * (face[0] + face[1] + face[2]);
  Corners t = shrunk(face, 0.4);
  EXPECT_LT(over(tree, t, 10).height, 1);
  for (Vector3& corner : t) corner = corner + 2000 * n;
  EXPECT_TRUE(std::isinf(over(tree, t, 1000).height)) << "higher than asked for";
  t = {middle, middle + 2.0 * (face[0] - middle), middle + 2.0 * (face[1] - middle)};
  EXPECT_TRUE(std::isinf(over(tree, t, 1000).height)) << "beyond its edge";
}

// Two layers, one of which looks down: together they prove nothing.
TEST(SurfaceOver, aThinWallProvesNothingFromItsInside) {
  Surface surface = sphere(0, 0);
  for (LatticePoint& p : surface.points) p[2] = 2 * kSize + (p[2] - 2 * kSize) / 1000;
  const TriangleTree tree = surface.tree();
  const double xy = 2.0 * kSize, z = xy + 30;
  const Corners t{Vector3{xy, xy, z}, {xy + 100, xy, z}, {xy, xy + 100, z}};
  EXPECT_TRUE(std::isinf(over(tree, t, 200).height));
  EXPECT_NEAR(over(tree, t, 50).height, 35, 1) << "the nearer layer alone does";
}

TEST(SurfaceOver, aPieceWithoutAnAreaIsNotJudged) {
  const Surface surface = sphere(0, 0);
  const TriangleTree tree = surface.tree();
  const Vector3 a{0, 0, 0}, b{1000, 0, 0};
  const std::array<Vector3, 3> line{a, b, 0.5 * (a + b)};
  EXPECT_TRUE(std::isinf(surfaceOver(tree, line, {0, 0, 1}, 1e6).height));
}

}  // namespace
}  // namespace qtet
