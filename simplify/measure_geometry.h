// Points in real lattice coordinates and the nearest point of a triangle: what error measurement computes with. + - * / and sqrt alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "codec/mesh.h"

namespace qtet {

/// A place in lattice coordinates, not rounded to the lattice.
using Point3 = std::array<double, 3>;

[[nodiscard]] inline Point3 toPoint3(const LatticePoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}
[[nodiscard]] inline Point3 operator-(const Point3& a, const Point3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
[[nodiscard]] inline double dot(const Point3& a, const Point3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
[[nodiscard]] inline Point3 cross(const Point3& a, const Point3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// sum of weights[i] * corners[i]
template <std::size_t N>
[[nodiscard]] Point3 blend(const std::array<Point3, N>& corners, const std::array<double, N>& weights) {
  Point3 out{};
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t k = 0; k < 3; ++k) out[k] += weights[i] * corners[i][k];
  return out;
}

struct NearestPoint {
  double squared = 0;               ///< squared distance, in squared lattice steps
  std::array<double, 3> weights{};  ///< barycentric, of the triangle's corners
};

/// The point of a triangle that is nearest to p; the triangle may be degenerate (Ericson, Real-Time Collision Detection, 5.1.5).
[[nodiscard]] NearestPoint nearestOnTriangle(const Point3& p, const std::array<Point3, 3>& triangle);

}  // namespace qtet
