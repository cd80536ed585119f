#include "simplify/measure/measure_samples.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace qtet {
namespace {

/// Uniform in the unit triangle: the square's other half is turned onto it.
std::array<double, 4> triangleWeights(SplitMix64& random) {
  double s = random.unit(), t = random.unit();
  if (s + t > 1) s = 1 - s, t = 1 - t;
  assert(s + t <= 1 && s >= 0 && t >= 0);
  return {1 - s - t, s, t, 0};
}

/// Uniform in the unit tetrahedron: the cube's other five parts are folded onto it (Rocchini &
/// Cignoni 2000).
std::array<double, 4> tetrahedronWeights(SplitMix64& random) {
  double s = random.unit(), t = random.unit(), u = random.unit();
  if (s + t > 1) s = 1 - s, t = 1 - t;
  if (t + u > 1) {
    const double old = u;
    u = 1 - s - t;
    t = 1 - old;
  } else if (s + t + u > 1) {
    const double old = u;
    u = s + t + u - 1;
    s = 1 - t - old;
  }
  return {1 - s - t - u, s, t, u};
}

/// One place in each of `count` equal parts of the total measure, cells lined up in the order of
/// `ids`.
template <std::size_t N>
std::vector<ErrorSample> stratified(std::span<const LatticePoint> points, CellSpan cells,
                                    std::span<const std::uint32_t> ids, std::size_t count,
                                    std::uint64_t seed) {
  double total = 0;
  for (const std::uint32_t id : ids) total += placesMeasure(cornersOf<N>(points, cells[id]));
  std::vector<ErrorSample> out;
  if (!(total > 0)) return out;
  out.reserve(count);
  PlaceDraw draw(total, count, seed);
  const auto drawIn = [&](std::uint32_t id) {
    const auto corners = cornersOf<N>(points, cells[id]);
    ErrorSample sample{{}, id, N == 3 ? draw.takeInTriangle() : draw.takeInTetrahedron()};
    std::array<double, N> own;
    std::copy_n(sample.weights.begin(), N, own.begin());
    sample.at = blend(corners, own);
    out.push_back(sample);
  };
  std::uint32_t lastWithMeasure = 0;
  for (const std::uint32_t id : ids) {
    const double measure = placesMeasure(cornersOf<N>(points, cells[id]));
    if (measure > 0) lastWithMeasure = id;
    draw.enter(measure);
    while (draw.hasPlace()) drawIn(id);
  }
  while (draw.isWanting()) drawIn(lastWithMeasure);  // what rounding left behind the end
  return out;
}

}  // namespace

double placesMeasure(const std::array<Vector3, 3>& t) {
  const Vector3 normal = cross(t[1] - t[0], t[2] - t[0]);
  return std::sqrt(dot(normal, normal));
}

double placesMeasure(const std::array<Vector3, 4>& t) {
  return std::abs(dot(cross(t[1] - t[0], t[2] - t[0]), t[3] - t[0]));
}

PlaceDraw::PlaceDraw(double total, std::size_t count, std::uint64_t seed)
    : total_(total), count_(count), random_(seed) {
  next();
}

void PlaceDraw::next() {
  wanted_ = (static_cast<double>(drawn_) + random_.unit()) / static_cast<double>(count_) * total_;
}

std::array<double, 4> PlaceDraw::takeInTriangle() {
  assert(isWanting());
  const std::array<double, 4> out = triangleWeights(random_);
  ++drawn_;
  next();
  return out;
}

std::array<double, 4> PlaceDraw::takeInTetrahedron() {
  assert(isWanting());
  const std::array<double, 4> out = tetrahedronWeights(random_);
  ++drawn_;
  next();
  return out;
}

std::vector<ErrorSample> samplesOnSurface(std::span<const LatticePoint> points, CellSpan cells,
                                          std::span<const std::uint32_t> ids, std::size_t count,
                                          std::uint64_t seed) {
  return stratified<3>(points, cells, ids, count, seed);
}

std::vector<ErrorSample> samplesInVolume(std::span<const LatticePoint> points, CellSpan cells,
                                         std::size_t count, std::uint64_t seed) {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < cells.size(); ++i)
    if (cells[i][3] != kGhost) ids.push_back(i);
  return stratified<4>(points, cells, ids, count, seed);
}

}  // namespace qtet
