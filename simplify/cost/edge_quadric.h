// The quadric of an edge (fusion_cost.h), or of two edges from one vertex at once: T is double, or
// Pair, one number an edge. Nothing else is computed as often (a million times in a mesh of 215,000
// cells).
#pragma once

#include <array>
#include <cstddef>

#include "codec/coding/pair.h"

namespace qtet {

/// E(d) = d^T A d + 2 b.d + c at the best values, d relative to the edge's first vertex.
template <class T>
struct EdgeQuadric {
  using Vector = std::array<T, 3>;

  std::array<T, 6> a;  // xx xy xz yy yz zz
  Vector b;
  T c, weight;  // the weight of the values, W

  [[nodiscard]] Vector times(const Vector& d) const {
    return {a[0] * d[0] + a[1] * d[1] + a[2] * d[2], a[1] * d[0] + a[3] * d[1] + a[4] * d[2],
            a[2] * d[0] + a[4] * d[1] + a[5] * d[2]};
  }
  [[nodiscard]] static T dot(const Vector& u, const Vector& v) {
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  }
  /// Never below zero, whatever rounding does.
  [[nodiscard]] T at(const Vector& d) const {
    const T value = dot(d, times(d)) + 2 * dot(b, d) + c;
    return value > 0 ? value : T{};
  }
  /// Quadric::minimum; where that says nothing, numbers that are not finite.
  [[nodiscard]] Vector minimum(const Vector& towards, const T& pull) const {
    const T one = T{} + 1.0, ix = one / (a[0] + pull);
    const T lxy = a[1] * ix, lxz = a[2] * ix;
    const T iy = one / (a[3] + pull - lxy * a[1]);
    const T yz = a[4] - lxy * a[2], lyz = yz * iy;
    const T zz = a[5] + pull - lxz * a[2] - lyz * yz;
    const T rx = pull * towards[0] - b[0], ry = pull * towards[1] - b[1] - lxy * rx,
            rz = pull * towards[2] - b[2] - lxz * rx - lyz * ry;
    const T z = rz / zz, y = (ry - yz * z) * iy;
    return {(rx - a[1] * y - a[2] * z) * ix, y, z};
  }
};

/// Sums what FusionCost keeps of the edge's vertices: `own` of the first, `other(i)` number i of
/// the second, `by` from the second to the first.
template <class T, class Other>
[[nodiscard]] inline EdgeQuadric<T> edgeQuadric(const double* own, const Other& other,
                                                const std::array<T, 3>& by,
                                                std::size_t components) {
  using Q = EdgeQuadric<T>;
  constexpr std::size_t kWeight = 10, kHead = kWeight + 1;
  Q q{{other(0), other(1), other(2), other(3), other(4), other(5)},
      {other(6), other(7), other(8)},
      {},
      own[kWeight] + other(kWeight)};
  const typename Q::Vector ad = q.times(by);
  q.c = own[9] + (Q::dot(by, ad) + 2 * Q::dot(q.b, by) + other(9));
  for (std::size_t i = 0; i < 6; ++i) q.a[i] = q.a[i] + own[i];
  for (std::size_t i = 0; i < 3; ++i) q.b[i] = own[6 + i] + (ad[i] + q.b[i]);
  const T one = T{} + 1.0, inverse = q.weight > 0 ? one / q.weight : T{};
  for (std::size_t f = kHead; f < kHead + components; ++f) {
    const std::size_t fy = f + components, fz = fy + components, offsets = fz + components,
                      values = offsets + components;
    const T x = other(f), y = other(fy), z = other(fz);
    const T along = x * by[0] + y * by[1] + z * by[2] + other(offsets);
    const T e = own[values] - other(values), we = other(kWeight) * e;
    const T gx = own[f] + x, gy = own[fy] + y, gz = own[fz] + z,
            offset = own[offsets] + (along - we);
    const T ix = inverse * gx, iy = inverse * gy, iz = inverse * gz, share = inverse * offset;
    q.a[0] -= ix * gx, q.a[1] -= ix * gy, q.a[2] -= ix * gz, q.a[3] -= iy * gy, q.a[4] -= iy * gz,
        q.a[5] -= iz * gz;
    q.b[0] -= e * x + share * gx, q.b[1] -= e * y + share * gy, q.b[2] -= e * z + share * gz;
    q.c -= e * (2 * along - we) + share * offset;
  }
  return q;
}

}  // namespace qtet
