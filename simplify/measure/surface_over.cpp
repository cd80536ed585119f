#include "simplify/measure/surface_over.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace qtet {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
/// Lattice steps between what ends below a plane and what begins above it: a thousand times what
/// doubles round at coordinates of 2^30.
constexpr double kApart = 0x1p-10;
/// Area over circumference, in lattice steps, of the narrowest piece: rounding is then below a
/// hundredth of its area.
constexpr double kMinWidth = 0x1p-8;
/// The part of the piece's area by which the sum of the layers may miss a whole number.
constexpr double kMissing = 0x1p-5;
/// Triangles over one piece: with more of them searching for nearest ones is cheaper.
constexpr std::size_t kMaxTriangles = 1 << 12;

struct Side {
  Vector3 inward;  // unit
  double offset;

  [[nodiscard]] double at(const Vector3& p) const { return dot(inward, p) - offset; }
};

/// A place over the piece: relative to its first corner, and how high it lies.
struct Place {
  Vector3 at;
  double height;
};

/// Three corners, and at most one more for each side that cuts.
struct Polygon {
  std::array<Place, 3 + kMaxCorners> places;
  std::size_t count = 0;
};

class Prism {
 public:
  Prism(std::span<const Vector3> piece, const Vector3& normal, double most)
      : origin_(piece[0]), normal_(normal), most_(most) {
    assert(piece.size() >= 3 && piece.size() <= kMaxCorners);
    double circumference = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Vector3 from = piece[i] - origin_, edge = piece[(i + 1) % piece.size()] - piece[i];
      const double length = std::sqrt(dot(edge, edge));
      circumference += length;
      area_ += dot(normal_, cross(from, edge));
      if (!(length > 0)) continue;
      const Vector3 inward = 1 / length * cross(normal_, edge);
      assert(sideCount_ < kMaxCorners);
      sides_[sideCount_++] = {inward, dot(inward, from)};
    }
    isWide_ = area_ >= 2 * kMinWidth * circumference;
  }

  [[nodiscard]] bool isWide() const { return isWide_; }

  /// False: the surface crosses a plane at `most`, or the layers cannot be counted.
  bool add(std::uint32_t id, const Corners& corners) {
    Polygon polygon;
    bool isAbove = true, isBelow = true;
    for (const Vector3& c : corners) {
      const Vector3 at = c - origin_;
      const double height = dot(normal_, at);
      isAbove &= height >= most_;
      isBelow &= height <= -most_;
      polygon.places[polygon.count++] = {at, height};
    }
    return isAbove || isBelow || !clip(polygon) || addLayer(id, polygon);
  }

  [[nodiscard]] SurfaceOver result() const {
    assert(isWide_);
    const double layers = sum_ / area_, whole = std::round(layers);
    if (whole == 0 || !(std::abs(layers - whole) < kMissing)) return {};
    return {highest_, triangle_, bound_};
  }

 private:
  // False: nothing is left of it. Most triangles lie beyond one side or within all: only the
  // others are cut.
  bool clip(Polygon& polygon) const {
    std::array<const Side*, kMaxCorners> cutting;
    std::size_t cuts = 0;
    for (std::size_t s = 0; s < sideCount_; ++s) {
      bool isOut = true, isIn = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const double in = sides_[s].at(polygon.places[i].at);
        isOut &= in <= 0;
        isIn &= in >= 0;
      }
      if (isOut) return false;
      assert(cuts < kMaxCorners);
      if (!isIn) cutting[cuts++] = &sides_[s];
    }
    Polygon other;
    Polygon *from = &polygon, *to = &other;
    for (std::size_t s = 0; s < cuts && from->count > 0; ++s) {
      cut(*from, *cutting[s], *to);
      std::swap(from, to);
    }
    if (from != &polygon) polygon = other;
    return polygon.count >= 3;
  }

  static void cut(const Polygon& from, const Side& side, Polygon& to) {
    assert(from.count <= from.places.size());
    to.count = 0;
    if (from.count == 0) return;
    const Place* a = &from.places[from.count - 1];
    double inA = side.at(a->at);
    for (std::size_t i = 0; i < from.count; ++i) {
      const Place* b = &from.places[i];
      const double inB = side.at(b->at);
      if ((inA > 0 && inB < 0) || (inA < 0 && inB > 0)) {
        const double t = inA / (inA - inB);
        to.places[to.count++] = {a->at + t * (b->at - a->at),
                                 a->height + t * (b->height - a->height)};
      }
      if (inB >= 0) to.places[to.count++] = *b;
      a = b;
      inA = inB;
    }
  }

  bool addLayer(std::uint32_t id, const Polygon& polygon) {
    assert(polygon.count >= 3);
    double low = kNone, high = -kNone, area = 0;
    const Vector3& first = polygon.places[0].at;
    for (std::size_t i = 0; i < polygon.count; ++i) {
      low = std::min(low, polygon.places[i].height);
      high = std::max(high, polygon.places[i].height);
      if (i >= 2)
        area += dot(normal_, cross(polygon.places[i - 1].at - first, polygon.places[i].at - first));
    }
    if (low >= most_ || high <= -most_) return true;
    if (low < kApart - most_ || high > most_ - kApart) return false;
    highest_ = std::max({highest_, -low, high});
    sum_ += area;
    if (std::abs(area) > largest_) largest_ = std::abs(area), triangle_ = id;
    bound_.add(id);
    return true;
  }

  Vector3 origin_, normal_;
  double most_;
  std::array<Side, kMaxCorners> sides_;
  std::size_t sideCount_ = 0;
  double area_ = 0;  // twice
  bool isWide_ = false;

  double sum_ = 0, highest_ = 0, largest_ = -1;  // areas: twice
  std::uint32_t triangle_ = 0;
  BoundTriangles bound_;
};

}  // namespace

SurfaceOver surfaceOver(const TriangleTree& surface, std::span<const Vector3> piece,
                        const Vector3& normal, double most) {
  Prism prism(piece, normal, most);
  if (!prism.isWide() || !(most > kApart)) return {};
  LatticePoint low, high;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [least, largest] =
        std::ranges::minmax(piece, {}, [&](const Vector3& c) { return c[k]; });
    const double reach = most * std::abs(normal[k]);
    low[k] = static_cast<std::int32_t>(std::floor(std::max(least[k] - reach, -0x1p30)));
    high[k] = static_cast<std::int32_t>(std::ceil(std::min(largest[k] + reach, 0x1p30)));
  }
  std::size_t looked = 0;
  bool isClear = true;
  surface.touching(low, high, [&](std::uint32_t id, const Corners& corners) {
    return isClear = ++looked <= kMaxTriangles && prism.add(id, corners);
  });
  return isClear ? prism.result() : SurfaceOver{};
}

}  // namespace qtet
