#include "server/store/cell_at_point.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "codec/picture/vector.h"

namespace qtet {
namespace {

/// A cell's corners as seen from the point.
using Corners = std::array<Vector, 4>;

/// Six times the volume of (0, a, b, c).
double volume(const Vector& a, const Vector& b, const Vector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

bool isNearBox(const Corners& corners, double near) {
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] =
        std::minmax({corners[0][a], corners[1][a], corners[2][a], corners[3][a]});
    if (low > near || high < -near) return false;
  }
  return true;
}

using Weights = std::array<double, 4>;

/// How far the place of these weights is from the point.
double distanceOf(const Weights& weights, const Corners& corners) {
  Vector sum{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t a = 0; a < 3; ++a) sum[a] += weights[i] * corners[i][a];
  return std::sqrt(dot(sum, sum));
}

/// The weights of the point in its cell; nullopt: it lies outside, or the cell has no volume.
std::optional<Weights> weightsInside(const Corners& p) {
  // what rounding moves the place by in a cell that is flat but for rounding
  constexpr double kRoundingSteps = 1e-3;
  Weights out = {volume(p[1], p[2], p[3]), -volume(p[0], p[2], p[3]), volume(p[0], p[1], p[3]),
                 -volume(p[0], p[1], p[2])};
  const double sum = out[0] + out[1] + out[2] + out[3];
  if (sum == 0 || !std::isfinite(sum)) return std::nullopt;
  for (double& weight : out) weight /= sum;
  if (std::ranges::min(out) < 0 || !(distanceOf(out, p) <= kRoundingSteps)) return std::nullopt;
  return out;
}

/// The weights of the triangle's point that is nearest to the origin (Ericson, Real-Time Collision
/// Detection, 5.1.5). Not finite for a triangle without area.
Vector nearestOfTriangle(const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = minus(b, a), ac = minus(c, a);
  const double d1 = -dot(ab, a), d2 = -dot(ac, a), d3 = -dot(ab, b), d4 = -dot(ac, b),
               d5 = -dot(ab, c), d6 = -dot(ac, c);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - along, along};
  }
  const double all = va + vb + vc;
  return {1 - (vb + vc) / all, vb / all, vc / all};
}

/// The weights of the cell's point that is nearest to a point outside.
Weights nearestOutside(const Corners& corners) {
  Weights best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t left = 0; left < 4; ++left) {  // the corner that the face lacks
    const std::size_t i = (left + 1) % 4, j = (left + 2) % 4, k = (left + 3) % 4;
    const Vector ofFace = nearestOfTriangle(corners[i], corners[j], corners[k]);
    Weights weights{};
    weights[i] = ofFace[0], weights[j] = ofFace[1], weights[k] = ofFace[2];
    if (const double distance = distanceOf(weights, corners); distance < least)
      least = distance, best = weights;
  }
  return best;
}

bool hasVolume(const Corners& p) {
  return volume(minus(p[1], p[0]), minus(p[2], p[0]), minus(p[3], p[0])) != 0;
}

}  // namespace

std::optional<PointInCell> cellAtPoint(std::span<const LatticePoint> points,
                                       std::span<const Tetrahedron> cells,
                                       const std::array<double, 3>& point, double near) {
  assert(near >= 0);
  std::optional<PointInCell> nearest;
  double least = near;
  for (CellId cell = 0; cell < cells.size(); ++cell) {
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t a = 0; a < 3; ++a) corners[i][a] = points[cells[cell][i]][a] - point[a];
    if (!isNearBox(corners, least)) continue;
    if (const auto inside = weightsInside(corners)) return PointInCell{cell, *inside};
    if (!hasVolume(corners)) continue;
    const Weights weights = nearestOutside(corners);
    const double distance = distanceOf(weights, corners);
    if (distance <= least) nearest = PointInCell{cell, weights}, least = distance;
  }
  return nearest;
}

std::array<LatticePoint, 2> boxOf(std::span<const LatticePoint> points) {
  LatticePoint low = points.empty() ? LatticePoint() : points.front(), high = low;
  for (const LatticePoint& p : points)
    for (std::size_t a = 0; a < 3; ++a)
      low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  return {low, high};
}

double nearStepsOf(std::span<const LatticePoint> points, const std::optional<LevelError>& error) {
  if (!error) return kNearSteps;
  const auto [low, high] = boxOf(points);
  Vector box{};
  for (std::size_t a = 0; a < 3; ++a) box[a] = static_cast<double>(high[a]) - low[a];
  // The error is a share of the original's diagonal D. Each side of its box is longer than the
  // level's by at most 2 e D. So D is at most the level's diagonal over 1 - 2 sqrt(3) e.
  constexpr double kMaxError = 0.2;
  const double e = std::min(error->toLevel.max, kMaxError);
  return kNearSteps + e * std::sqrt(dot(box, box)) / (1 - 2 * std::sqrt(3.0) * e);
}

}  // namespace qtet
