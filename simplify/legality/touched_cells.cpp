#include "simplify/legality/touched_cells.h"

#include <cassert>

namespace qtet {
namespace {

/// Clear of what rounding does to a height, over the squared extent.
constexpr double kHeightSlack = 1e-9;

// The range of n x where x <= limit / n, or x >= limit / n.
void narrow(double n, double limit, CellRows::Range& range) {
  if (n > 0)
    range[1] = std::min(range[1], limit / n + kTouchSlack);
  else if (n < 0)
    range[0] = std::max(range[0], limit / n - kTouchSlack);
  else if (limit < 0)
    range[1] = range[0] - 2;
}

}  // namespace

CellRows::CellRows(const Corners& corners) {
  Vector3 largest{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3& from = corners[(i + 1) % 4];
    const Vector3 n = cross(corners[(i + 2) % 4] - from, corners[(i + 3) % 4] - from);
    if (dot(n, n) > dot(largest, largest)) largest = n;
  }
  std::size_t first = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(largest[k]) > std::abs(largest[first])) first = k;
  axes_ = {first, (first + 1) % 3, (first + 2) % 3};
  double extent = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    origin_[k] = low_[k] = high_[k] = corners[0][axes_[k]];
    for (std::size_t i = 0; i < 4; ++i) {
      low_[k] = std::min(low_[k], corners[i][axes_[k]]);
      high_[k] = std::max(high_[k], corners[i][axes_[k]]);
      at_[i][k] = corners[i][axes_[k]] - origin_[k];
    }
    low_[k] = std::max(low_[k] - kTouchSlack, 0.0), high_[k] += kTouchSlack;
    extent = std::max(extent, high_[k] - low_[k]);
  }
  assert(low_[0] <= high_[0] && low_[1] <= high_[1] && low_[2] <= high_[2]);
  slack_ = kHeightSlack * extent * extent;
  for (std::size_t i = 0; i < 4; ++i) addFace(i);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) addOutline(i, j);
}

void CellRows::addFace(std::size_t opposite) {
  const Vector3& from = at_[(opposite + 1) % 4];
  Vector3 normal = cross(at_[(opposite + 2) % 4] - from, at_[(opposite + 3) % 4] - from);
  const double inner = dot(normal, at_[opposite] - from);
  if (inner > 0) normal = -1.0 * normal;
  // a flat one has nothing inside
  if (std::abs(inner) > slack_) faces_.add({normal, dot(normal, from) + slack_});
}

void CellRows::addOutline(std::size_t a, std::size_t b) {
  const Vector3 edge = at_[b] - at_[a];
  Vector3 normal{0, edge[2], -edge[1]};
  double low = 0, high = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == a || i == b) continue;
    const double beside = dot(normal, at_[i] - at_[a]);
    low = std::min(low, beside), high = std::max(high, beside);
  }
  if (low < 0 && high > 0) return;
  if (high > 0) normal = -1.0 * normal;
  outlines_.add({normal, dot(normal, at_[a]) + slack_});
}

void CellRows::narrowLayer(double third, Range& second) const {
  const double z = third - origin_[2];
  for (const HalfSpace& h : outlines_.all()) {
    const double least = std::min(h.normal[2] * z, h.normal[2] * (z + 1));
    Range range{second[0] - origin_[1], second[1] - origin_[1]};
    narrow(h.normal[1], h.height - least, range);
    second = {range[0] + origin_[1], range[1] + origin_[1]};
  }
}

void CellRows::narrowRow(double third, double second, Range& first) const {
  const double y = second - origin_[1], z = third - origin_[2];
  Range range{first[0] - origin_[0], first[1] - origin_[0]};
  for (const HalfSpace& h : faces_.all()) {
    const double least = std::min(h.normal[1] * y, h.normal[1] * (y + 1)) +
                         std::min(h.normal[2] * z, h.normal[2] * (z + 1));
    narrow(h.normal[0], h.height - least, range);
  }
  first = {range[0] + origin_[0], range[1] + origin_[0]};
}

}  // namespace qtet
