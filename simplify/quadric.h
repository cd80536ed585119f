// The planar quadric error metric of the paper (Chopra & Meyer, section 3.3): squared distances to planes as one symmetric 4x4 matrix.
#pragma once

#include <array>
#include <cmath>
#include <optional>

namespace qtet {

using Vector3 = std::array<double, 3>;

[[nodiscard]] inline Vector3 operator-(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
[[nodiscard]] inline Vector3 operator+(const Vector3& a, const Vector3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
[[nodiscard]] inline Vector3 operator*(double s, const Vector3& a) { return {s * a[0], s * a[1], s * a[2]}; }
[[nodiscard]] inline double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
[[nodiscard]] inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Delta(v) = v^T Q v of Eq. 3 with v = [x y z 1]. Sums of quadrics are quadrics of the union of the planes (Eq. 4).
class Quadric {
 public:
  /// Adds the plane of a triangle with weight (area * factor)^2, Eq. 1-3; a triangle without area adds nothing.
  void addTriangle(const Vector3& a, const Vector3& b, const Vector3& c, double factor) {
    const Vector3 n = cross(b - a, c - a);  // length = twice the area, so n/2 is already a_p times the unit normal
    const double w = 0.25 * factor * factor;
    const double d = -dot(n, a);  // Eq. 2
    const std::array<double, 4> p{n[0], n[1], n[2], d};
    std::size_t at = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i; j < 4; ++j) q_[at++] += w * p[i] * p[j];
  }
  Quadric& operator+=(const Quadric& other) {
    for (std::size_t i = 0; i < q_.size(); ++i) q_[i] += other.q_[i];
    return *this;
  }
  /// Eq. 5; never below zero, whatever rounding does.
  [[nodiscard]] double at(const Vector3& v) const {
    const double value = q_[0] * v[0] * v[0] + q_[4] * v[1] * v[1] + q_[7] * v[2] * v[2] + q_[9] +
                         2 * (q_[1] * v[0] * v[1] + q_[2] * v[0] * v[2] + q_[5] * v[1] * v[2] + q_[3] * v[0] + q_[6] * v[1] + q_[8] * v[2]);
    return value > 0 ? value : 0;
  }
  /// The point where Delta is least (Eq. 6-7), or nothing where the matrix is too close to singular to say.
  [[nodiscard]] std::optional<Vector3> minimum() const {
    const Vector3 r0{q_[0], q_[1], q_[2]};
    const Vector3 r1{q_[1], q_[4], q_[5]};
    const Vector3 r2{q_[2], q_[5], q_[7]};
    const Vector3 c0 = cross(r1, r2);
    const double determinant = dot(r0, c0);
    const double scale = (q_[0] + q_[4] + q_[7]) / 3;
    if (!(determinant > kSingular * scale * scale * scale)) return std::nullopt;
    return (-1 / determinant) * (q_[3] * c0 + q_[6] * cross(r2, r0) + q_[8] * cross(r0, r1));
  }

 private:
  // Relative determinant below which Eq. 6's inverse is noise: the paper settles on the barycentre then.
  static constexpr double kSingular = 1e-10;

  std::array<double, 10> q_{};  // xx xy xz xw yy yz yw zz zw ww
};

}  // namespace qtet
