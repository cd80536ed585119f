#include "server/store/cell_at_point.h"

#include <algorithm>
#include <cmath>

namespace qtet {
namespace {

using Vector = std::array<double, 3>;
/// A cell's corners as seen from the point.
using Corners = std::array<Vector, 4>;

/// Six times the volume of (0, a, b, c).
double volume(const Vector& a, const Vector& b, const Vector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

bool isNearBox(const Corners& corners) {
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] =
        std::minmax({corners[0][a], corners[1][a], corners[2][a], corners[3][a]});
    if (low > kNearSteps || high < -kNearSteps) return false;
  }
  return true;
}

/// nullopt: the cell has no volume.
std::optional<std::array<double, 4>> weightsOf(const Corners& p) {
  std::array<double, 4> out = {volume(p[1], p[2], p[3]), -volume(p[0], p[2], p[3]),
                               volume(p[0], p[1], p[3]), -volume(p[0], p[1], p[2])};
  const double sum = out[0] + out[1] + out[2] + out[3];
  if (sum == 0 || !std::isfinite(sum)) return std::nullopt;
  for (double& weight : out) weight /= sum;
  return out;
}

/// Leaves out the negative weights. Returns how far the point then lies from where it was.
double clampWeights(std::array<double, 4>& weights, const Corners& corners) {
  double sum = 0;
  for (double& weight : weights) sum += weight = std::max(weight, 0.0);
  Vector moved{};
  for (std::size_t i = 0; i < 4; ++i) {
    weights[i] /= sum;
    for (std::size_t a = 0; a < 3; ++a) moved[a] += weights[i] * corners[i][a];
  }
  return std::hypot(moved[0], moved[1], moved[2]);
}

}  // namespace

std::optional<PointInCell> cellAtPoint(std::span<const LatticePoint> points,
                                       std::span<const Tetrahedron> cells,
                                       const std::array<double, 3>& point) {
  std::optional<PointInCell> nearest;
  double least = kNearSteps;
  for (CellId cell = 0; cell < cells.size(); ++cell) {
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t a = 0; a < 3; ++a) corners[i][a] = points[cells[cell][i]][a] - point[a];
    if (!isNearBox(corners)) continue;
    std::optional<std::array<double, 4>> weights = weightsOf(corners);
    if (!weights) continue;
    if (std::ranges::min(*weights) >= 0) return PointInCell{cell, *weights};
    const double distance = clampWeights(*weights, corners);
    if (distance <= least) nearest = PointInCell{cell, *weights}, least = distance;
  }
  return nearest;
}

}  // namespace qtet
