#include "codec/picture/first_camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace qtet {
namespace {

/// From the mesh to the eye.
constexpr Vector kDirection = {0.62, -1, 0.55};
constexpr double kFieldOfViewDegrees = 32;
/// The share of the free width or height that a fitted mesh fills.
constexpr double kFill = 0.88;
/// Width over height of the free area that the mesh is fitted to.
constexpr double kAspect = 4.0 / 3.0;
/// The least distance of the eye, and of the near plane, in halves of the bounds' diagonal.
constexpr double kMinDistance = 0.05, kMinNear = 0.01;
/// So many directions bound a mesh to a few per cent.
constexpr int kDirections = 128;

Vector pointOf(const LatticePoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// The farthest vertices of the boundary in many directions: a spiral from pole to pole.
std::vector<Vector> outlineOf(const LatticeMesh& mesh) {
  std::vector<Vector> out;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2.0 * i + 1) / kDirections, radius = std::sqrt(1 - z * z);
    const Vector direction = {radius * std::cos(golden * i), radius * std::sin(golden * i), z};
    double best = std::numeric_limits<double>::lowest();
    Vector farthest{};
    for (const Triangle& triangle : mesh.boundary)
      for (const VertexId v : triangle) {
        const Vector p = pointOf(mesh.points[v]);
        const double height = dot(direction, p);
        if (height > best) best = height, farthest = p;
      }
    out.push_back(farthest);
  }
  return out;
}

std::vector<Vector> cornersOf(const Bounds& box) {
  std::vector<Vector> out;
  for (unsigned i = 0; i < 8; ++i) {
    Vector corner{};
    for (unsigned axis = 0; axis < 3; ++axis)
      corner[axis] = (i >> axis & 1) != 0 ? box.high[axis] : box.low[axis];
    out.push_back(corner);
  }
  return out;
}

/// The side of the focus at a face of the bounds that faces the eye. nullopt if no such face is
/// near, because walls would hide the focus.
std::optional<Bounds> seenPart(const Bounds& focus, const Bounds& bounds) {
  std::array<double, 3> gaps{};
  const auto side = [](const Bounds& box, std::size_t axis) {
    return kDirection[axis] > 0 ? box.high[axis] : box.low[axis];
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    gaps[axis] =
        std::abs(side(bounds, axis) - side(focus, axis)) / (focus.high[axis] - focus.low[axis]);
  const auto axis = static_cast<std::size_t>(std::ranges::min_element(gaps) - gaps.begin());
  if (gaps[axis] >= 1) return std::nullopt;
  Bounds out = focus;
  out.low[axis] = out.high[axis] = side(bounds, axis);
  return out;
}

Bounds latticeBox(const Focus& focus, int bits) {
  Bounds out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    constexpr int kDigits = std::numeric_limits<Focus::value_type>::digits;
    out.low[axis] = std::ldexp(focus[axis], bits - kDigits);
    out.high[axis] = std::ldexp(focus[axis + 3], bits - kDigits);
  }
  return out;
}

}  // namespace

Vector unit(const Vector& a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? Vector{a[0] / length, a[1] / length, a[2] / length} : a;
}

Bounds boundsOf(const LatticeMesh& mesh) {
  assert(!mesh.boundary.empty());
  Bounds out;
  out.low.fill(std::numeric_limits<double>::max());
  out.high.fill(std::numeric_limits<double>::lowest());
  for (const Triangle& triangle : mesh.boundary)
    for (const VertexId v : triangle)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = mesh.points[v][axis];
        out.low[axis] = std::min(out.low[axis], x);
        out.high[axis] = std::max(out.high[axis], x);
      }
  return out;
}

FirstCamera::FirstCamera(const LatticeMesh& mesh, const std::optional<Focus>& focus) {
  towards_ = unit(kDirection);
  right_ = unit(cross({0, 0, 1}, towards_));
  up_ = cross(towards_, right_);
  const Bounds bounds = boundsOf(mesh);
  const std::optional<Bounds> part =
      focus ? seenPart(latticeBox(*focus, mesh.lattice.bits), bounds) : std::nullopt;
  showsPart_ = part.has_value();
  const std::vector<Vector> points = part ? cornersOf(*part) : outlineOf(mesh);

  Vector middle{}, extent{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    middle[axis] = (bounds.low[axis] + bounds.high[axis]) / 2;
    extent[axis] = bounds.high[axis] - bounds.low[axis];
  }
  const double radius = std::max(std::sqrt(dot(extent, extent)), 1.0) / 2;
  const double tangent = std::tan(kFieldOfViewDegrees / 2 * std::numbers::pi / 180);
  distance_ = kMinDistance * radius;
  const double depth = dot(middle, towards_);
  std::array<double, 2> centre{};
  for (const std::size_t side : {0u, 1u}) {
    const Vector& axis = side == 0 ? right_ : up_;
    const double k = kFill * tangent * (side == 0 ? kAspect : 1);
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    for (const Vector& p : points) {
      const double a = dot(p, axis), c = k * (dot(p, towards_) - depth);
      low = std::min(low, a - c);
      high = std::max(high, a + c);
    }
    distance_ = std::max(distance_, (high - low) / (2 * k));
    centre[side] = (low + high) / 2;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    target_[axis] = centre[0] * right_[axis] + centre[1] * up_[axis] + depth * towards_[axis];
  near_ = kMinNear * radius;
  for (const Vector& p : points) {
    const Vector seen = view(p);
    for (const std::size_t side : {0u, 1u})
      halfExtent_[side] = std::max(halfExtent_[side], std::abs(seen[side]) / seen[2]);
  }
}

Vector FirstCamera::view(const Vector& lattice) const {
  const Vector p = {lattice[0] - target_[0], lattice[1] - target_[1], lattice[2] - target_[2]};
  return {dot(p, right_), dot(p, up_), distance_ - dot(p, towards_)};
}

}  // namespace qtet
