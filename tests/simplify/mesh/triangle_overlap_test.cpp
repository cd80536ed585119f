#include "simplify/mesh/triangle_overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "proto/limits.h"
#include "tests/support/exact_geometry.h"

namespace qtet {
namespace {

using testing::Point;

Point exact(const LatticePoint& p) { return {p[0], p[1], p[2]}; }

std::array<Point, 3> exact(const PlacedTriangle& t) {
  return {exact(t.at[0]), exact(t.at[1]), exact(t.at[2])};
}

bool isFlat(const PlacedTriangle& t) {
  const auto [a, b, c] = exact(t);
  // beside three points that are in no plane with any other three
  return testing::sideOf(a, b, c, {97, 89, 83}) == 0 &&
         testing::sideOf(a, b, c, {-71, 61, 53}) == 0 &&
         testing::sideOf(a, b, c, {43, -37, 101}) == 0;
}

/// Follows the definition: the edges that are not common to both, against the other triangle.
bool plainOverlap(const PlacedTriangle& one, const PlacedTriangle& other) {
  const auto isIn = [](VertexId v, const PlacedTriangle& t) {
    return std::ranges::find(t.vertex, v) != t.vertex.end();
  };
  const auto common = std::ranges::count_if(one.vertex, [&](VertexId v) { return isIn(v, other); });
  bool meets = false;
  const auto check = [&](const PlacedTriangle& of, const PlacedTriangle& with) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      // with one vertex in common, what lies opposite of it
      if (common == 1 && (isIn(of.vertex[i], with) || isIn(of.vertex[next], with))) continue;
      meets |= testing::segmentMeetsTriangle(exact(of.at[i]), exact(of.at[next]), exact(with));
    }
  };
  if (common == 3) return true;
  if (common < 2) {
    check(one, other), check(other, one);
    return meets;
  }
  // With an edge in common: the third corner of one lies in the other's plane. A segment that stays
  // off the edge joins one of the two third corners to a point of the other triangle.
  std::array<Point, 2> edge{};
  Point ours{}, theirs{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (isIn(one.vertex[i], other))
      edge[n++] = exact(one.at[i]);
    else
      ours = exact(one.at[i]);
  for (std::size_t i = 0; i < 3; ++i)
    if (!isIn(other.vertex[i], one)) theirs = exact(other.at[i]);
  if (testing::sideOf(edge[0], edge[1], ours, theirs) != 0) return false;
  // A point off the plane makes the two sides of the edge two sides of a plane.
  for (const Point& off : {Point{97, 89, 83}, Point{-71, 61, 53}, Point{43, -37, 101}})
    if (testing::sideOf(edge[0], edge[1], ours, off) != 0)
      return testing::sideOf(edge[0], edge[1], off, ours) ==
             testing::sideOf(edge[0], edge[1], off, theirs);
  return true;
}

class TriangleOverlap : public ::testing::TestWithParam<std::size_t> {};

TEST_P(TriangleOverlap, isWhatThePlainOneFinds) {
  const std::size_t common = GetParam();
  std::mt19937 random(17);
  std::array<std::size_t, 2> count{};
  for (int trial = 0; trial < 20000; ++trial) {
    const std::uint32_t size = trial % 2 == 0 ? 4 : 40;
    const auto point = [&] {
      const auto x = [&] { return static_cast<std::int32_t>(random() % size); };
      return LatticePoint{x(), x(), x()};
    };
    PlacedTriangle one{{1, 2, 3}, {point(), point(), point()}};
    PlacedTriangle other{{4, 5, 6}, {point(), point(), point()}};
    for (std::size_t i = 0; i < common; ++i)
      other.vertex[i] = one.vertex[(i + 1) % 3], other.at[i] = one.at[(i + 1) % 3];
    std::ranges::rotate(other.vertex, other.vertex.begin() + trial % 3);
    std::ranges::rotate(other.at, other.at.begin() + trial % 3);
    if (isFlat(one) || isFlat(other)) continue;
    const bool expected = plainOverlap(one, other);
    ASSERT_EQ(overlap(one, other), expected) << "trial " << trial;
    ASSERT_EQ(overlap(other, one), expected) << "trial " << trial;
    ++count[expected];
  }
  EXPECT_GT(count[0], 100u);
  EXPECT_GT(count[1], 100u);
}

INSTANTIATE_TEST_SUITE_P(VerticesInCommon, TriangleOverlap, ::testing::Values(0, 1, 2));

TEST(TriangleOverlap, ofTheSameVerticesOrWithoutAreaIsTrueWhereTheyAreNear) {
  const PlacedTriangle one{{1, 2, 3}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}};
  EXPECT_TRUE(overlap(one, {{3, 2, 1}, {{{0, 4, 0}, {4, 0, 0}, {0, 0, 0}}}}));
  EXPECT_TRUE(overlap(one, {{4, 5, 6}, {{{1, 1, 0}, {2, 2, 0}, {3, 3, 0}}}}));
  EXPECT_FALSE(overlap(one, {{4, 5, 6}, {{{9, 9, 9}, {10, 10, 10}, {11, 11, 11}}}}));
}

TEST(TriangleOverlap, isExactAtTheLatticesEnd) {
  constexpr std::int32_t kEnd = (1 << kMaxPositionBits) - 1;
  const PlacedTriangle flat{{1, 2, 3}, {{{0, 0, kEnd}, {kEnd, 0, 0}, {0, kEnd, 0}}}};
  // the plane x + y + z = kEnd, and a segment that ends one step before it, on it, or beyond
  const auto needle = [](std::int32_t z) {
    return PlacedTriangle{{4, 5, 6}, {{{1, 1, 0}, {2, 1, 0}, {1000, 2000, z}}}};
  };
  EXPECT_FALSE(overlap(flat, needle(kEnd - 3001)));
  EXPECT_TRUE(overlap(flat, needle(kEnd - 3000)));
  EXPECT_TRUE(overlap(flat, needle(kEnd - 2999)));
}

}  // namespace
}  // namespace qtet
