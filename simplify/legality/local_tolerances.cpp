#include "simplify/legality/local_tolerances.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "simplify/legality/original_surface.h"

namespace qtet {
namespace {

/// Two sheets that both grow by this share of their distance keep half of it.
constexpr double kShare = 0.25;
/// Weights of the middle in the places near a large triangle's corners from which it looks too.
constexpr double kFromCorner = 0.125;
/// A line that passes beside a triangle by less, over its length, hits it: none slips between two.
constexpr double kEdge = 1e-9;

/// Where the line at + t * along passes the triangle; infinity where it does not.
double passingAt(const Vector3& at, const Vector3& along, const std::array<Vector3, 3>& triangle) {
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  const Vector3 u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  const Vector3 across = cross(along, v), from = at - triangle[0];
  const double scale = dot(u, across);
  if (scale == 0) return kNowhere;
  const double first = dot(from, across) / scale;
  if (first < -kEdge || first > 1 + kEdge) return kNowhere;
  const Vector3 turned = cross(from, u);
  const double second = dot(along, turned) / scale;
  if (second < -kEdge || first + second > 1 + kEdge) return kNowhere;
  return dot(v, turned) / scale;
}

class Lookout {
 public:
  Lookout(const TriangleTree& tree, double most)
      : tree_(tree), reach_(most / kShare), most_(most), out_(tree.builtOver(), floatBelow(most)) {}

  void lookFrom(std::uint32_t triangle) {
    assert(triangle < out_.size());
    const auto corners = tree_.corners(triangle);
    const Vector3 u = corners[1] - corners[0], v = corners[2] - corners[0], normal = cross(u, v);
    const double length = std::sqrt(dot(normal, normal));
    if (!(length > 0)) {
      out_[triangle] = 0;
      return;
    }
    const Vector3 along = reach_ / length * normal,
                  middle = 1 / 3.0 * (corners[0] + corners[1] + corners[2]);
    look(triangle, middle, along);
    if (std::max(dot(u, u), dot(v, v)) <= most_ * most_) return;
    for (const Vector3& c : corners)
      look(triangle, kFromCorner * middle + (1 - kFromCorner) * c, along);
  }
  void keep(std::uint32_t triangle) { out_[triangle] = 0; }
  [[nodiscard]] std::vector<float> take() { return std::move(out_); }

 private:
  // The nearest triangle outwards. One that touches this one lies at 0, or as near as doubles tell.
  void look(std::uint32_t triangle, const Vector3& from, const Vector3& along) {
    double nearest = 1;
    std::uint32_t hit = triangle;
    tree_.crossing(from - kEdge * along, from + along,
                   [&](std::uint32_t other, const std::array<Vector3, 3>& corners) {
                     if (other == triangle) return;
                     const double at = passingAt(from, along, corners);
                     if (at >= -kEdge && at < nearest) nearest = std::max(at, 0.0), hit = other;
                   });
    assert(hit < out_.size() && nearest >= 0 && nearest <= 1);
    for (const std::uint32_t t : {triangle, hit})
      out_[t] = std::min(out_[t], floatBelow(nearest * most_));
  }

  const TriangleTree& tree_;
  double reach_, most_;
  std::vector<float> out_;
};

}  // namespace

std::vector<float> localTolerances(const TriangleTree& tree, double most,
                                   std::span<const std::uint8_t> isSeam) {
  assert(most > 0 && (isSeam.empty() || isSeam.size() == tree.builtOver()));
  Lookout lookout(tree, most);
  for (std::uint32_t t = 0; t < tree.builtOver(); ++t) {
    if (!isSeam.empty() && isSeam[t]) {
      lookout.keep(t);
    } else {
      lookout.lookFrom(t);
    }
  }
  return lookout.take();
}

}  // namespace qtet
