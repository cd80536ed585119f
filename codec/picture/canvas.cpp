#include "codec/picture/canvas.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace qtet {
namespace {

/// Samples a pixel along each axis.
constexpr int kSamples = 2;
/// The share of the smaller side in which a faded picture vanishes.
constexpr double kFadingShare = 0.18;

/// A corner in samples from the picture's upper left corner.
struct Spot {
  double x, y, nearness, value;
};

/// Twice the signed area of a, b and (x, y).
double edge(const Spot& a, const Spot& b, double x, double y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

}  // namespace

Canvas::Canvas(int width, int height, const std::array<double, 2>& halfExtent)
    : width_(width),
      height_(height),
      columns_(width * kSamples),
      rows_(height * kSamples),
      halfExtent_(halfExtent),
      nearness_(index(0, rows_)),
      colours_(index(0, rows_)) {
  assert(width > 0 && height > 0 && halfExtent[0] > 0 && halfExtent[1] > 0);
}

void Canvas::draw(std::span<const Corner> polygon,
                  const std::function<std::array<double, 3>(double)>& shade) {
  assert(std::ranges::all_of(polygon, [](const Corner& corner) { return corner.place[2] > 0; }));
  for (std::size_t i = 2; i < polygon.size(); ++i)
    drawTriangle({polygon[0], polygon[i - 1], polygon[i]}, shade);
}

void Canvas::drawTriangle(const std::array<Corner, 3>& corners,
                          const std::function<std::array<double, 3>(double)>& shade) {
  std::array<Spot, 3> spots{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [place, value] = corners[k];
    const double x = place[0] / place[2] / halfExtent_[0], y = place[1] / place[2] / halfExtent_[1];
    spots[k] = {columns_ * (1 + x) / 2, rows_ * (1 - y) / 2, 1 / place[2], value};
  }
  const auto& [a, b, c] = spots;
  const double area = edge(a, b, c.x, c.y);
  if (area == 0) return;
  const auto [left, right] = std::minmax({a.x, b.x, c.x});
  const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
  const int firstColumn = static_cast<int>(std::clamp<double>(left, 0, columns_)),
            endColumn = static_cast<int>(std::clamp<double>(right + 1, 0, columns_)),
            firstRow = static_cast<int>(std::clamp<double>(top, 0, rows_)),
            endRow = static_cast<int>(std::clamp<double>(bottom + 1, 0, rows_));
  for (int row = firstRow; row < endRow; ++row)
    for (int column = firstColumn; column < endColumn; ++column) {
      const double x = column + 0.5, y = row + 0.5;
      const double u = edge(b, c, x, y) / area, v = edge(c, a, x, y) / area, w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      const double nearness = u * a.nearness + v * b.nearness + w * c.nearness;
      const std::size_t at = index(column, row);
      if (static_cast<float>(nearness) <= nearness_[at]) continue;
      nearness_[at] = static_cast<float>(nearness);
      const double value =
          (u * a.nearness * a.value + v * b.nearness * b.value + w * c.nearness * c.value) /
          nearness;
      const std::array<double, 3> colour = shade(value);
      for (std::size_t i = 0; i < 3; ++i) colours_[at][i] = static_cast<float>(colour[i]);
    }
}

void Canvas::fade() { fades_ = true; }

double Canvas::visibility(int column, int row) const {
  if (!fades_) return 1;
  const int gap = std::min({column, row, width_ - 1 - column, height_ - 1 - row});
  const double t = std::min(1.0, (gap + 0.5) / (kFadingShare * std::min(width_, height_)));
  return t * t * (3 - 2 * t);
}

Bytes Canvas::pixels() const {
  Bytes out;
  out.reserve(std::size_t{4} * static_cast<std::size_t>(width_) *
              static_cast<std::size_t>(height_));
  for (int row = 0; row < height_; ++row)
    for (int column = 0; column < width_; ++column) {
      std::array<double, 3> sum{};
      int covered = 0;
      for (int i = 0; i < kSamples * kSamples; ++i) {
        const std::size_t at =
            index(column * kSamples + i % kSamples, row * kSamples + i / kSamples);
        if (nearness_[at] == 0) continue;
        ++covered;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(colours_[at][c]);
      }
      for (const double part : sum)
        out.push_back(covered == 0 ? std::uint8_t{0}
                                   : static_cast<std::uint8_t>(
                                         std::floor(255 * std::min(1.0, part / covered) + 0.5)));
      out.push_back(static_cast<std::uint8_t>(
          std::floor(visibility(column, row) * covered * 255 / (kSamples * kSamples) + 0.5)));
    }
  return out;
}

}  // namespace qtet
