#include "simplify/mesh/triangle_overlap.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "codec/mesh/predicates.h"

namespace qtet {
namespace {

using Corners = std::array<LatticePoint, 3>;
using Normal = std::array<std::int64_t, 3>;

int signOf(std::int64_t x) { return (x > 0) - (x < 0); }

// Differences are below 2^kMaxPositionBits = 2^28, so each component is below 2^57.
Normal normalOf(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
  const detail::Difference u = detail::difference(a, b), v = detail::difference(a, c);
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

bool isFlat(const Corners& t) { return normalOf(t[0], t[1], t[2]) == Normal{}; }

std::size_t largest(const Normal& normal) {
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  return axis;
}

// The side of the line through a and b on which c lies, all in one plane, seen along this axis.
int sideOf(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, std::size_t axis) {
  return signOf(normalOf(a, b, c)[axis]);
}

bool isBetween(const LatticePoint& p, const LatticePoint& a, const LatticePoint& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (p[k] < std::min(a[k], b[k]) || p[k] > std::max(a[k], b[k])) return false;
  return true;
}

// Whether two closed segments in one plane meet.
bool segmentsMeet(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                  const LatticePoint& d, std::size_t axis) {
  const int ofC = sideOf(a, b, c, axis), ofD = sideOf(a, b, d, axis), ofA = sideOf(c, d, a, axis),
            ofB = sideOf(c, d, b, axis);
  if (ofC * ofD < 0 && ofA * ofB < 0) return true;
  return (ofC == 0 && isBetween(c, a, b)) || (ofD == 0 && isBetween(d, a, b)) ||
         (ofA == 0 && isBetween(a, c, d)) || (ofB == 0 && isBetween(b, c, d));
}

bool meetsInPlane(const LatticePoint& a, const LatticePoint& b, const Corners& t) {
  const std::size_t axis = largest(normalOf(t[0], t[1], t[2]));
  bool left = true, right = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (segmentsMeet(a, b, t[i], t[(i + 1) % 3], axis)) return true;
    const int side = sideOf(t[i], t[(i + 1) % 3], a, axis);
    left &= side >= 0, right &= side <= 0;
  }
  return left || right;
}

// Whether a closed segment and a closed triangle meet.
bool meets(const LatticePoint& a, const LatticePoint& b, const Corners& t) {
  const int ofA = orientation(t[0], t[1], t[2], a), ofB = orientation(t[0], t[1], t[2], b);
  if (ofA * ofB > 0) return false;
  if (ofA == 0 && ofB == 0) return meetsInPlane(a, b, t);
  bool left = true, right = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = orientation(a, b, t[i], t[(i + 1) % 3]);
    left &= side >= 0, right &= side <= 0;
  }
  return left || right;
}

bool areApart(const Corners& one, const Corners& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax({one[0][k], one[1][k], one[2][k]});
    const auto [otherLow, otherHigh] = std::minmax({other[0][k], other[1][k], other[2][k]});
    if (high < otherLow || otherHigh < low) return true;
  }
  return false;
}

// With the vertices in common first, in the same order.
struct Aligned {
  Corners one, other;
  std::size_t common = 0;
};

Aligned aligned(const PlacedTriangle& one, const PlacedTriangle& other) {
  Aligned out{one.at, other.at, 0};
  std::array<VertexId, 3> ours = one.vertex, theirs = other.vertex;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto same =
        std::ranges::find(theirs.begin() + static_cast<int>(out.common), theirs.end(), ours[i]);
    if (same == theirs.end()) continue;
    const auto at = static_cast<std::size_t>(same - theirs.begin());
    std::swap(out.one[i], out.one[out.common]), std::swap(ours[i], ours[out.common]);
    std::swap(out.other[at], out.other[out.common]), std::swap(theirs[at], theirs[out.common]);
    ++out.common;
  }
  return out;
}

// Both have the edge t[0]-t[1]: they share more where they lie on one side of it in one plane.
bool areFolded(const Corners& one, const Corners& other) {
  if (orientation(one[0], one[1], one[2], other[2]) != 0) return false;
  const Normal normal = normalOf(one[0], one[1], one[2]);
  const std::size_t axis = largest(normal);
  return signOf(normal[axis]) == sideOf(one[0], one[1], other[2], axis);
}

bool anyEdgeMeets(const Corners& of, const Corners& t) {
  return meets(of[0], of[1], t) || meets(of[1], of[2], t) || meets(of[2], of[0], t);
}

}  // namespace

bool overlap(const PlacedTriangle& one, const PlacedTriangle& other) {
  if (areApart(one.at, other.at)) return false;
  if (isFlat(one.at) || isFlat(other.at)) return true;
  const Aligned both = aligned(one, other);
  switch (both.common) {
    case 0: return anyEdgeMeets(both.one, both.other) || anyEdgeMeets(both.other, both.one);
    case 1:
      return meets(both.one[1], both.one[2], both.other) ||
             meets(both.other[1], both.other[2], both.one);
    case 2: return areFolded(both.one, both.other);
    default: return true;
  }
}

}  // namespace qtet
