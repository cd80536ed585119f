// Points in real lattice coordinates and the nearest point of a triangle: what error measurement
// computes with. + - * / and sqrt alone.
#pragma once

#include <array>
#include <cstddef>

#include "simplify/mesh/vector3.h"

namespace qtet {

/// sum of weights[i] * corners[i]
template <std::size_t N>
[[nodiscard]] Vector3 blend(const std::array<Vector3, N>& corners,
                            const std::array<double, N>& weights) {
  Vector3 out{};
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t k = 0; k < 3; ++k) out[k] += weights[i] * corners[i][k];
  return out;
}

struct NearestPoint {
  double squared = 0;               ///< squared distance, in squared lattice steps
  std::array<double, 3> weights{};  ///< barycentric, of the triangle's corners
};

/// The point of a triangle that is nearest to p; the triangle may be degenerate (Ericson, Real-Time
/// Collision Detection, 5.1.5).
[[nodiscard]] NearestPoint nearestOnTriangle(const Vector3& p,
                                             const std::array<Vector3, 3>& triangle);

}  // namespace qtet
