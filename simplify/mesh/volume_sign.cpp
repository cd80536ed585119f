#include "simplify/mesh/volume_sign.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cassert>
#include <cmath>

namespace qtet {
namespace {

using boost::multiprecision::cpp_int;

/// Relative error of the rounded determinant against its permanent, (7 + 56 e) e with e = 2^-53
/// (Shewchuk 1997, "orient3d", bound A).
constexpr double kErrorBound = 7.7715611723761027e-16;
/// Below this the products may have lost bits to underflow, which the bound does not cover.
constexpr double kSmallestTrustedPermanent = 1e-200;

struct Edges {
  Position u, v, w;
};

Position minus(const Position& p, const Position& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

double determinant(const Edges& e) {
  return (e.u[1] * e.v[2] - e.u[2] * e.v[1]) * e.w[0] +
         (e.u[2] * e.v[0] - e.u[0] * e.v[2]) * e.w[1] +
         (e.u[0] * e.v[1] - e.u[1] * e.v[0]) * e.w[2];
}

/// The determinant with every term positive.
double permanent(const Edges& e) {
  const auto product = [](double p, double q) { return std::abs(p * q); };
  return (product(e.u[1], e.v[2]) + product(e.u[2], e.v[1])) * std::abs(e.w[0]) +
         (product(e.u[2], e.v[0]) + product(e.u[0], e.v[2])) * std::abs(e.w[1]) +
         (product(e.u[0], e.v[1]) + product(e.u[1], e.v[0])) * std::abs(e.w[2]);
}

[[maybe_unused]] bool isFinite(const Position& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

using ExactPosition = std::array<cpp_int, 3>;

/// The coordinates as integers: multiples of the smallest power of two among their last bits.
std::array<ExactPosition, 4> exactPositions(const std::array<Position, 4>& positions) {
  int smallest = 2000;
  for (const Position& p : positions) {
    for (const double x : p) {
      if (x != 0) smallest = std::min(smallest, std::ilogb(x) - 52);
    }
  }
  std::array<ExactPosition, 4> out;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = positions[i][k];
      if (x == 0) continue;
      const int exponent = std::ilogb(x) - 52;
      out[i][k] = static_cast<long long>(std::scalbn(x, -exponent));
      out[i][k] <<= exponent - smallest;
    }
  }
  return out;
}

int exactSign(const std::array<Position, 4>& positions) {
  const std::array<ExactPosition, 4> p = exactPositions(positions);
  std::array<ExactPosition, 3> e;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) e[i][k] = p[i + 1][k] - p[0][k];
  }
  const cpp_int volume = (e[0][1] * e[1][2] - e[0][2] * e[1][1]) * e[2][0] +
                         (e[0][2] * e[1][0] - e[0][0] * e[1][2]) * e[2][1] +
                         (e[0][0] * e[1][1] - e[0][1] * e[1][0]) * e[2][2];
  return volume.sign();
}

}  // namespace

double roundedVolume6(const Position& a, const Position& b, const Position& c, const Position& d) {
  return determinant({minus(b, a), minus(c, a), minus(d, a)});
}

int volumeSign(const Position& a, const Position& b, const Position& c, const Position& d) {
  assert(isFinite(a) && isFinite(b) && isFinite(c) && isFinite(d));
  const Edges edges{minus(b, a), minus(c, a), minus(d, a)};
  const double volume = determinant(edges);
  const double bound = permanent(edges);
  // Not-a-number and infinity (coordinates near the largest double) fail both comparisons and go
  // the exact way.
  if (bound > kSmallestTrustedPermanent && bound < 1e300) {
    if (volume > kErrorBound * bound) return 1;
    if (volume < -kErrorBound * bound) return -1;
  }
  return exactSign({a, b, c, d});
}

}  // namespace qtet
