// Exact predicates on integer points for checking meshes, written from the definitions: nothing of
// them is the simplifier's or the codec's.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace qtet::testing {

/// REQUIRES everywhere: |coordinate| < 2^30, so that cross products fit 64 bits and their dot
/// products 128.
using Point = std::array<std::int64_t, 3>;

/// Six times the signed volume of a, b, c, d; above 2^63 it does not fit, which 20 bits a
/// coordinate rule out.
[[nodiscard]] std::int64_t volume6Of(const Point& a, const Point& b, const Point& c,
                                     const Point& d);
/// Its sign, at any size.
[[nodiscard]] int sideOf(const Point& a, const Point& b, const Point& c, const Point& d);

/// Whether the segment p q and the triangle a b c, both closed, have a point in common. REQUIRES:
/// the triangle is not degenerate.
[[nodiscard]] bool segmentMeetsTriangle(const Point& p, const Point& q,
                                        const std::array<Point, 3>& triangle);

/// Whether the open tetrahedron and the closed convex hull of `other` (3 or 4 points, not
/// degenerate) have a point in common. Uses separating axes. For a polyhedron with an inside and
/// another convex one, these are the face normals of both and the products of their edges.
[[nodiscard]] bool insideMeets(const std::array<Point, 4>& tetrahedron,
                               std::span<const Point> other);

/// Whether the closed tetrahedron of positive volume holds p.
[[nodiscard]] bool holds(const std::array<Point, 4>& tetrahedron, const Point& p);

struct Box {
  Point low{}, high{};
};
[[nodiscard]] Box boxOf(std::span<const Point> points);

/// Calls visit(i, j) once for every a[i] and b[j] that have a point in common; near-linear for
/// boxes of about one size (a uniform grid).
template <class Visit>
void forEachBoxPair(std::span<const Box> a, std::span<const Box> b, const Visit& visit) {
  if (a.empty() || b.empty()) return;
  Box all = b[0];
  for (const Box& box : b)
    for (std::size_t k = 0; k < 3; ++k)
      all.low[k] = std::min(all.low[k], box.low[k]),
      all.high[k] = std::max(all.high[k], box.high[k]);
  const auto bins = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(std::cbrt(static_cast<double>(b.size()))));
  const auto bin = [&](std::int64_t x, std::size_t k) {
    return std::clamp<std::int64_t>((x - all.low[k]) * bins / (all.high[k] - all.low[k] + 1), 0,
                                    bins - 1);
  };
  const auto forEachBin = [&](const Box& box, const auto& with) {
    for (auto x = bin(box.low[0], 0); x <= bin(box.high[0], 0); ++x)
      for (auto y = bin(box.low[1], 1); y <= bin(box.high[1], 1); ++y)
        for (auto z = bin(box.low[2], 2); z <= bin(box.high[2], 2); ++z)
          with(std::array{x, y, z}, static_cast<std::size_t>((x * bins + y) * bins + z));
  };
  std::vector<std::vector<std::size_t>> members(static_cast<std::size_t>(bins * bins * bins));
  for (std::size_t j = 0; j < b.size(); ++j)
    forEachBin(b[j], [&](const auto&, std::size_t at) { members[at].push_back(j); });
  for (std::size_t i = 0; i < a.size(); ++i)
    forEachBin(a[i], [&](const std::array<std::int64_t, 3>& here, std::size_t at) {
      for (const std::size_t j : members[at]) {
        // first: of the bins that both lie in, so that a pair is visited once
        bool meet = true, first = true;
        for (std::size_t k = 0; k < 3; ++k) {
          meet &= a[i].low[k] <= b[j].high[k] && b[j].low[k] <= a[i].high[k];
          first &= here[k] == bin(std::max(a[i].low[k], b[j].low[k]), k);
        }
        if (meet && first) visit(i, j);
      }
    });
}

}  // namespace qtet::testing
