#include "simplify/clean/hanging_points.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

struct Box {
  Position low, high;
};

/// Points split at their medians, axis by axis; what is below a place of `ids_` stands left of it.
class PointTree {
 public:
  PointTree(std::span<const Position> points, std::vector<VertexId> ids)
      : points_(points), ids_(std::move(ids)) {
    build(0, ids_.size(), 0);
  }

  template <class Visit>
  void within(const Box& box, const Visit& visit) const {
    visitWithin(0, ids_.size(), 0, box, visit);
  }

 private:
  void build(std::size_t begin, std::size_t end, std::size_t axis) {
    if (end - begin < 2) return;
    assert(axis < 3 && end <= ids_.size());
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t i) { return ids_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
                     [&](VertexId a, VertexId b) { return points_[a][axis] < points_[b][axis]; });
    build(begin, middle, (axis + 1) % 3);
    build(middle + 1, end, (axis + 1) % 3);
  }

  template <class Visit>
  void visitWithin(std::size_t begin, std::size_t end, std::size_t axis, const Box& box,
                   const Visit& visit) const {
    if (begin >= end) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const Position& p = points_[ids_[middle]];
    if (box.low[axis] <= p[axis]) visitWithin(begin, middle, (axis + 1) % 3, box, visit);
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k)
      inside = inside && box.low[k] <= p[k] && p[k] <= box.high[k];
    if (inside) visit(ids_[middle]);
    if (p[axis] <= box.high[axis]) visitWithin(middle + 1, end, (axis + 1) % 3, box, visit);
  }

  std::span<const Position> points_;
  std::vector<VertexId> ids_;
};

/// A triangle with what every test of a point against it needs.
class Flat {
 public:
  Flat(const Position& a, const Position& b, const Position& c)
      : corners_{a, b, c}, normal_(cross(b - a, c - a)) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 edge = corners_[(k + 1) % 3] - corners_[k];
      longest2_ = std::max(longest2_, dot(edge, edge));
    }
  }

  [[nodiscard]] double tolerance2() const {
    return kHangingTolerance * kHangingTolerance * longest2_;
  }

  /// Whether p lies on it, on its edges included, and not at a corner.
  [[nodiscard]] bool carries(const Position& p) const {
    for (const Position& corner : corners_) {
      const Vector3 d = p - corner;
      if (dot(d, d) <= tolerance2()) return false;
    }
    const double area2 = dot(normal_, normal_);
    if (area2 <= tolerance2() * longest2_) return false;  // a needle has no inside
    const double height = dot(p - corners_[0], normal_);
    if (height * height > tolerance2() * area2) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 edge = corners_[(k + 1) % 3] - corners_[k];
      // distance from the edge's line x edge length x |normal|
      const double side = dot(cross(edge, p - corners_[k]), normal_);
      if (side < 0 && side * side > tolerance2() * dot(edge, edge) * area2) return false;
    }
    return true;
  }

 private:
  std::array<Position, 3> corners_;
  Vector3 normal_;
  double longest2_ = 0;
};

}  // namespace

std::vector<VertexId> hangingPointsOf(std::span<const Position> points,
                                      std::span<const Triangle> boundary) {
  std::vector<VertexId> ids;
  for (const Triangle& t : boundary) ids.insert(ids.end(), t.begin(), t.end());
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const PointTree tree(points, ids);
  std::vector<VertexId> hanging;
  for (const Triangle& t : boundary) {
    const Flat flat(points[t[0]], points[t[1]], points[t[2]]);
    Box box{points[t[0]], points[t[0]]};
    const double tolerance = std::sqrt(flat.tolerance2());
    for (const VertexId v : t) {
      for (std::size_t k = 0; k < 3; ++k)
        box.low[k] = std::min(box.low[k], points[v][k] - tolerance),
        box.high[k] = std::max(box.high[k], points[v][k] + tolerance);
    }
    tree.within(box, [&](VertexId v) {
      if (v != t[0] && v != t[1] && v != t[2] && flat.carries(points[v])) hanging.push_back(v);
    });
  }
  std::ranges::sort(hanging);
  hanging.erase(std::unique(hanging.begin(), hanging.end()), hanging.end());
  return hanging;
}

}  // namespace qtet
