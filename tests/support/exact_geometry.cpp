#include "tests/support/exact_geometry.h"

namespace qtet::testing {
namespace {

__extension__ typedef __int128 Wide;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Wide dot(const Point& a, const Point& b) {
  return Wide{a[0]} * b[0] + Wide{a[1]} * b[1] + Wide{a[2]} * b[2];
}
int sign(Wide x) { return (x > 0) - (x < 0); }

/// The turn of a, b, c, projected along axis `drop`: +1 counter-clockwise, 0 in line.
int turn(const Point& a, const Point& b, const Point& c, std::size_t drop) {
  const std::size_t x = (drop + 1) % 3, y = (drop + 2) % 3;
  return sign(Wide{b[x] - a[x]} * (c[y] - a[y]) - Wide{b[y] - a[y]} * (c[x] - a[x]));
}

bool between(const Point& p, const Point& a, const Point& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (p[k] < std::min(a[k], b[k]) || p[k] > std::max(a[k], b[k])) return false;
  return true;
}

/// Closed segments of one plane.
bool segmentsMeet(const Point& p, const Point& q, const Point& a, const Point& b,
                  std::size_t drop) {
  const int pa = turn(a, b, p, drop), qa = turn(a, b, q, drop), ap = turn(p, q, a, drop),
            bp = turn(p, q, b, drop);
  if (pa * qa < 0 && ap * bp < 0) return true;
  return (pa == 0 && between(p, a, b)) || (qa == 0 && between(q, a, b)) ||
         (ap == 0 && between(a, p, q)) || (bp == 0 && between(b, p, q));
}

bool meetInPlane(const Point& p, const Point& q, const std::array<Point, 3>& t,
                 const Point& normal) {
  const std::size_t drop = normal[0] != 0 ? 0 : normal[1] != 0 ? 1 : 2;
  const int a = turn(t[0], t[1], p, drop), b = turn(t[1], t[2], p, drop),
            c = turn(t[2], t[0], p, drop);
  // p lies in the triangle
  if ((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0)) return true;
  for (std::size_t i = 0; i < 3; ++i)
    if (segmentsMeet(p, q, t[i], t[(i + 1) % 3], drop)) return true;
  return false;
}

/// Whether the plane across `axis` has the open tetrahedron on one side and `other` on the other
/// side or in it.
bool separates(const Point& axis, const std::array<Point, 4>& tetrahedron,
               std::span<const Point> other) {
  if (axis == Point{}) return false;
  const auto by = [&](const Point& p, const Point& q) { return dot(axis, p) < dot(axis, q); };
  const auto [low, high] = std::ranges::minmax_element(tetrahedron, by);
  const auto [otherLow, otherHigh] = std::ranges::minmax_element(other, by);
  return dot(axis, *high) <= dot(axis, *otherLow) || dot(axis, *otherHigh) <= dot(axis, *low);
}

bool someFaceSeparates(std::span<const Point> faces, const std::array<Point, 4>& tetrahedron,
                       std::span<const Point> other) {
  const std::size_t n = faces.size();
  // of a triangle the one face, of a tetrahedron four
  for (std::size_t skip = 0; skip < (n == 4 ? 4 : 1); ++skip) {
    const Point &a = faces[(skip + 1) % n], &b = faces[(skip + 2) % n], &c = faces[(skip + 3) % n];
    if (separates(cross(minus(b, a), minus(c, a)), tetrahedron, other)) return true;
  }
  return false;
}

}  // namespace

std::int64_t volume6Of(const Point& a, const Point& b, const Point& c, const Point& d) {
  return static_cast<std::int64_t>(dot(cross(minus(b, a), minus(c, a)), minus(d, a)));
}

int sideOf(const Point& a, const Point& b, const Point& c, const Point& d) {
  return sign(dot(cross(minus(b, a), minus(c, a)), minus(d, a)));
}

bool segmentMeetsTriangle(const Point& p, const Point& q, const std::array<Point, 3>& t) {
  const int above = sideOf(t[0], t[1], t[2], p), below = sideOf(t[0], t[1], t[2], q);
  if (above * below > 0) return false;
  if (above == 0 && below == 0)
    return meetInPlane(p, q, t, cross(minus(t[1], t[0]), minus(t[2], t[0])));
  const int a = sideOf(p, q, t[0], t[1]), b = sideOf(p, q, t[1], t[2]),
            c = sideOf(p, q, t[2], t[0]);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

bool insideMeets(const std::array<Point, 4>& tetrahedron, std::span<const Point> other) {
  if (someFaceSeparates(tetrahedron, tetrahedron, other) ||
      someFaceSeparates(other, tetrahedron, other))
    return false;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t m = 0; m < other.size(); ++m)
        for (std::size_t n = 0; n < m; ++n)
          if (separates(cross(minus(tetrahedron[i], tetrahedron[j]), minus(other[m], other[n])),
                        tetrahedron, other))
            return false;
  return true;
}

bool holds(const std::array<Point, 4>& t, const Point& p) {
  return sideOf(t[0], t[1], t[2], p) >= 0 && sideOf(t[0], t[3], t[1], p) >= 0 &&
         sideOf(t[0], t[2], t[3], p) >= 0 && sideOf(t[1], t[3], t[2], p) >= 0;
}

Box boxOf(std::span<const Point> points) {
  Box box{points[0], points[0]};
  for (const Point& p : points)
    for (std::size_t k = 0; k < 3; ++k)
      box.low[k] = std::min(box.low[k], p[k]), box.high[k] = std::max(box.high[k], p[k]);
  return box;
}

}  // namespace qtet::testing
