// The unit cubes that a tetrahedron touches, row by row.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "simplify/legality/fixed_list.h"
#include "simplify/mesh/vector3.h"

namespace qtet {

/// Clear of what rounding does to a range, in cubes.
inline constexpr double kTouchSlack = 1e-6;

/// A tetrahedron as what half spaces share, relative to its first corner. Its axes are in an order
/// in which rows along the first one pass its largest face.
class CellRows {
 public:
  using Corners = std::array<Vector3, 4>;
  using Range = std::array<double, 2>;

  explicit CellRows(const Corners& corners);
  /// Number 0 is the axis of the rows.
  [[nodiscard]] std::size_t axis(std::size_t number) const {
    assert(number < 3);
    return axes_[number];
  }
  [[nodiscard]] const Vector3& low() const { return low_; }
  [[nodiscard]] const Vector3& high() const { return high_; }
  /// Narrows a range of the second axis to what the layer at `third` may touch.
  void narrowLayer(double third, Range& second) const;
  /// Narrows a range of the first axis to what the row may touch.
  void narrowRow(double third, double second, Range& first) const;

 private:
  // normal * (p - first corner) <= height; the axes in order
  struct HalfSpace {
    Vector3 normal;
    double height;
  };
  void addFace(std::size_t opposite);
  void addOutline(std::size_t a, std::size_t b);

  std::array<Vector3, 4> at_{};  // the axes in order, relative to the first corner
  std::array<std::size_t, 3> axes_{};
  Vector3 origin_{}, low_{}, high_{};  // the axes in order
  double slack_ = 0;
  FixedList<HalfSpace, 4> faces_;
  FixedList<HalfSpace, 6> outlines_;  // along the rows
};

/// Calls visit(cell) for each cube that the tetrahedron touches, and perhaps a few beside it, until
/// it returns false. REQUIRES: coordinates in [0, 2^20).
template <class Visit>
void eachTouchedCell(const std::array<Vector3, 4>& corners, const Visit& visit) {
  const CellRows rows(corners);
  const auto cellAt = [](double x) { return static_cast<std::int32_t>(std::floor(x)); };
  std::array<std::int32_t, 3> cell{};
  std::int32_t &x = cell[rows.axis(0)], &y = cell[rows.axis(1)], &z = cell[rows.axis(2)];
  for (z = cellAt(rows.low()[2]); z <= cellAt(rows.high()[2]); ++z) {
    CellRows::Range across{rows.low()[1], rows.high()[1]};
    rows.narrowLayer(z, across);
    for (y = cellAt(across[0]); y <= cellAt(across[1]); ++y) {
      CellRows::Range along{rows.low()[0], rows.high()[0]};
      rows.narrowRow(z, y, along);
      const std::int32_t end = cellAt(along[1]);
      for (x = cellAt(along[0]); x <= end; ++x)
        if (!visit(cell)) return;
    }
  }
}

}  // namespace qtet
