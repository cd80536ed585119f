#include "simplify/measure/farthest_point.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "simplify/measure/surface_over.h"

namespace qtet {
namespace {

/// Searches for one triangle. Measured: nearly all take fewer than twenty.
constexpr std::size_t kMaxSearches = 400;
/// A cut leaves out what is nearer to the plane, in lattice steps: less is rounding.
constexpr double kMinCut = 0x1p-16;

/// A convex piece of the triangle.
struct Piece {
  std::array<Vector3, kMaxCorners> corners;
  std::size_t count;
  std::uint32_t guess;
  double bound;

  void add(const Vector3& corner) {
    assert(count < kMaxCorners);
    corners[count++] = corner;
  }
  [[nodiscard]] Vector3 middle() const {
    assert(count >= 3);
    Vector3 sum{};
    for (std::size_t i = 0; i < count; ++i) sum = sum + corners[i];
    return 1.0 / static_cast<double>(count) * sum;
  }
};

struct Plane {
  Vector3 normal;  // a unit vector
  double offset;

  [[nodiscard]] double at(const Vector3& p) const { return dot(normal, p) - offset; }
};

Plane planeThrough(const Vector3& p, const Vector3& direction) {
  const double length = std::sqrt(dot(direction, direction));
  const Vector3 normal = length > 0 ? 1 / length * direction : Vector3{};
  return {normal, dot(normal, p)};
}

bool isBelow(const Piece& a, const Piece& b) { return a.bound < b.bound; }

class Search {
 public:
  Search(const TriangleTree& tree, double enough) : tree_(tree), enough_(enough) {}

  FarthestPoint of(const Corners& corners, std::uint32_t guess) {
    Piece whole{{}, 0, guess, std::numeric_limits<double>::infinity()};
    for (const Vector3& corner : corners) whole.add(corner);
    normal_ =
        planeThrough(corners[0], cross(corners[1] - corners[0], corners[2] - corners[0])).normal;
    examine(whole);
    const std::uint32_t nearest = nearest_;
    while (!waiting_.empty() && waiting_.front().bound > acceptable() && searches_ < kMaxSearches) {
      std::ranges::pop_heap(waiting_, isBelow);
      const Piece piece = waiting_.back();
      waiting_.pop_back();
      examine(piece);
    }
    if (!waiting_.empty()) accepted_ = std::max(accepted_, waiting_.front().bound);
    return {found_, std::max(found_, accepted_), nearest, bound_};
  }

 private:
  [[nodiscard]] double acceptable() const { return withTolerance(std::max(found_, enough_)); }

  /// The squared distance, or any that is not above `limit`.
  double searched(const Vector3& at, std::uint32_t guess, double limit) {
    assert(limit >= 0);
    ++searches_;
    NearestTriangle nearest;
    tree_.tryTriangle(at, guess, nearest);
    tree_.nearest(at, nearest, limit);
    nearest_ = nearest.triangle;
    bound_.add(nearest_);
    if (nearest.point.squared > limit) found_ = std::max(found_, nearest.point.squared);
    return nearest.point.squared;
  }

  void examine(Piece piece) {
    assert(piece.count >= 3 && piece.count <= kMaxCorners);
    if (isUnder(piece)) return;
    const Vector3 middle = piece.middle();
    double radius = 0;
    for (std::size_t i = 0; i < piece.count; ++i)
      radius = std::max(radius, dot(piece.corners[i] - middle, piece.corners[i] - middle));
    radius = std::sqrt(radius);
    const double spare = std::max(std::sqrt(acceptable()) - radius, 0.0);
    const double away = std::sqrt(searched(middle, piece.guess, spare * spare)) + radius;
    piece.guess = nearest_;
    piece.bound = std::min({piece.bound, away * away, boundBy(piece)});
    if (!isDone(piece)) split(piece, middle);
  }

  // Whether the surface is over all of the piece, nowhere higher than acceptable.
  bool isUnder(const Piece& piece) {
    const SurfaceOver over = surfaceOver(tree_, std::span(piece.corners).first(piece.count),
                                         normal_, std::sqrt(acceptable()));
    if (std::isinf(over.height)) return false;
    nearest_ = over.triangle;
    assert(over.height >= 0 && over.cover.count > 0);
    bound_.add(over.cover);
    accepted_ = std::max(accepted_, over.height * over.height);
    return true;
  }

  /// The bound from the piece's distance to its triangle alone.
  [[nodiscard]] double boundBy(const Piece& piece) const {
    const Corners to = tree_.corners(piece.guess);
    double out = 0;
    for (std::size_t i = 0; i < piece.count; ++i)
      out = std::max(out, nearestOnTriangle(piece.corners[i], to).squared);
    return out;
  }

  bool isDone(const Piece& piece) {
    if (piece.bound > acceptable()) return false;
    accepted_ = std::max(accepted_, piece.bound);
    return true;
  }

  // Cuts off the part over the nearest triangle along one of its edges, so that a flat surface
  // needs no more pieces than triangles. The corners bound a piece that is all over the triangle;
  // after that it is halved.
  void split(Piece& piece, const Vector3& middle) {
    if (piece.count == kMaxCorners) {
      halve(piece);
      return;
    }
    const Corners to = tree_.corners(piece.guess);
    const Vector3 normal = cross(to[1] - to[0], to[2] - to[0]);
    Plane best{};
    double deepest = kMinCut;
    for (std::size_t i = 0; i < 3; ++i) {
      const Plane edge = planeThrough(to[i], cross(normal, to[(i + 1) % 3] - to[i]));
      double in = 0, out = 0;
      for (std::size_t c = 0; c < piece.count; ++c) {
        in = std::max(in, edge.at(piece.corners[c]));
        out = std::max(out, -edge.at(piece.corners[c]));
      }
      if (std::min(in, out) > deepest) deepest = std::min(in, out), best = edge;
    }
    if (deepest > kMinCut) {
      cut(piece, best);
      return;
    }
    Vector3 longest{};
    const std::uint32_t guess = piece.guess;
    for (std::size_t c = 0; c < piece.count; ++c) {
      const Vector3 spoke = piece.corners[c] - middle;
      if (dot(spoke, spoke) > dot(longest, longest)) longest = spoke;
      (void)searched(piece.corners[c], guess, acceptable());
    }
    if (!isDone(piece)) cut(piece, planeThrough(middle, longest));
  }

  void cut(const Piece& piece, const Plane& plane) {
    Piece front{{}, 0, piece.guess, piece.bound}, back = front;
    for (std::size_t i = 0; i < piece.count; ++i) {
      const Vector3 &a = piece.corners[i], &b = piece.corners[(i + 1) % piece.count];
      const double da = plane.at(a), db = plane.at(b);
      if (da >= 0) front.add(a);
      if (da <= 0) back.add(a);
      if (da * db >= 0) continue;
      const Vector3 between = a + da / (da - db) * (b - a);
      front.add(between);
      back.add(between);
    }
    keep(front);
    keep(back);
  }

  void halve(const Piece& piece) {
    Piece front{{}, 0, piece.guess, piece.bound}, back = front;
    for (std::size_t i = 0; i <= piece.count / 2; ++i) front.add(piece.corners[i]);
    for (std::size_t i = piece.count / 2; i <= piece.count; ++i)
      back.add(piece.corners[i % piece.count]);
    keep(front);
    keep(back);
  }

  void keep(Piece& piece) {
    if (piece.count < 3) return;  // the cut went along its edge
    piece.bound = std::min(piece.bound, boundBy(piece));
    if (isDone(piece)) return;
    waiting_.push_back(piece);
    std::ranges::push_heap(waiting_, isBelow);
  }

  const TriangleTree& tree_;
  Vector3 normal_{};  // of the triangle, a unit vector
  double enough_, found_ = 0, accepted_ = 0;
  std::size_t searches_ = 0;
  std::uint32_t nearest_ = 0;
  BoundTriangles bound_;
  std::vector<Piece> waiting_;  // a heap, the largest bound in front
};

}  // namespace

double farthestCorner(const Corners& corners, const Corners& to) {
  double out = 0;
  for (const Vector3& corner : corners) out = std::max(out, nearestOnTriangle(corner, to).squared);
  return out;
}

double withTolerance(double found) {
  assert(found >= 0);
  return found * (1 + kFarthestTolerance) * (1 + kFarthestTolerance);
}

FarthestPoint farthestPoint(const TriangleTree& tree, const Corners& corners, std::uint32_t guess,
                            double enough) {
  assert(tree.builtOver() > 0 && enough >= 0);
  return Search(tree, enough).of(corners, guess);
}

}  // namespace qtet
