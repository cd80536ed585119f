// Quadrics: sums of squared distances to planes (Eq. 1-7 of the paper), and of squared residuals of
// linear fields, as functions of a point.
#pragma once

#include <array>
#include <optional>

#include "simplify/mesh/vector3.h"

namespace qtet {

/// The symmetric matrix (xx xy xz / xy yy yz / xz yz zz).
struct Symmetric3 {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void addOuter(const Vector3& n, double weight) {
    xx += weight * n[0] * n[0], xy += weight * n[0] * n[1], xz += weight * n[0] * n[2];
    yy += weight * n[1] * n[1], yz += weight * n[1] * n[2], zz += weight * n[2] * n[2];
  }
  Symmetric3& operator+=(const Symmetric3& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    return *this;
  }
  [[nodiscard]] Vector3 operator*(const Vector3& d) const {
    return {xx * d[0] + xy * d[1] + xz * d[2], xy * d[0] + yy * d[1] + yz * d[2],
            xz * d[0] + yz * d[1] + zz * d[2]};
  }
  [[nodiscard]] double trace() const { return xx + yy + zz; }
};

/// E(d) = d^T A d + 2 b.d + c, d relative to an origin that the owner knows. It is Eq. 3-5 with the
/// plane's offset kept small, so that nothing cancels.
struct Quadric {
  Symmetric3 a;
  Vector3 b{};
  double c = 0;

  /// Eq. 5; never below zero, whatever rounding does.
  [[nodiscard]] double at(const Vector3& d) const {
    const double value = dot(d, a * d) + 2 * dot(b, d) + c;
    return value > 0 ? value : 0;
  }
  /// Where E(d) + pull |d - towards|^2 is least (Eq. 6-7, the pull standing in where the matrix is
  /// singular); nothing where even that is too flat to say.
  [[nodiscard]] std::optional<Vector3> minimum(const Vector3& towards, double pull) const {
    // Gauss's elimination of a matrix that is positive definite up to rounding.
    const double xx = a.xx + pull;
    if (!(xx > 0)) return std::nullopt;
    const double lxy = a.xy / xx, lxz = a.xz / xx;
    const double yy = a.yy + pull - lxy * a.xy;
    const double yz = a.yz - lxy * a.xz;
    if (!(yy > 0)) return std::nullopt;
    const double lyz = yz / yy;
    const double zz = a.zz + pull - lxz * a.xz - lyz * yz;
    if (!(zz > 0)) return std::nullopt;
    const Vector3 right = pull * towards - b;
    const double ry = right[1] - lxy * right[0];
    const double z = (right[2] - lxz * right[0] - lyz * ry) / zz;
    const double y = (ry - yz * z) / yy;
    return Vector3{(right[0] - a.xy * y - a.xz * z) / xx, y, z};
  }
};

}  // namespace qtet
