#include "simplify/measure/measure_samples.h"
#include "simplify/mesh/split_mix64.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace qtet {
namespace {

template <std::size_t N>
std::array<Vector3, N> cornersOf(std::span<const LatticePoint> points,
                                 const std::array<VertexId, 4>& cell) {
  std::array<Vector3, N> out;
  for (std::size_t i = 0; i < N; ++i) out[i] = toVector(points[cell[i]]);
  return out;
}

double areaOf(const std::array<Vector3, 3>& t) {
  const Vector3 normal = cross(t[1] - t[0], t[2] - t[0]);
  return std::sqrt(dot(normal, normal));
}

double volumeOf(const std::array<Vector3, 4>& t) {
  return std::abs(dot(cross(t[1] - t[0], t[2] - t[0]), t[3] - t[0]));
}

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
template <std::size_t N, class MeasureOf, class Weights>
std::vector<ErrorSample> stratified(std::span<const LatticePoint> points, CellSpan cells,
                                    std::span<const std::uint32_t> ids, std::size_t count,
                                    std::uint64_t seed, const MeasureOf& measureOf,
                                    const Weights& weights) {
  double total = 0;
  for (const std::uint32_t id : ids) total += measureOf(cornersOf<N>(points, cells[id]));
  std::vector<ErrorSample> out;
  if (!(total > 0)) return out;
  out.reserve(count);
  SplitMix64 random(seed);
  const auto next = [&] {
    return (static_cast<double>(out.size()) + random.unit()) / static_cast<double>(count) * total;
  };
  double end = 0, wanted = next();
  std::size_t lastWithMeasure = 0;
  const auto drawIn = [&](std::uint32_t id) {
    assert(out.size() < count);
    const auto corners = cornersOf<N>(points, cells[id]);
    ErrorSample sample{{}, id, weights(random)};
    std::array<double, N> own;
    std::copy_n(sample.weights.begin(), N, own.begin());
    sample.at = blend(corners, own);
    out.push_back(sample);
    wanted = next();
  };
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const double measure = measureOf(cornersOf<N>(points, cells[ids[i]]));
    end += measure;
    if (measure > 0) lastWithMeasure = i;
    while (measure > 0 && wanted < end && out.size() < count) drawIn(ids[i]);
  }
  while (out.size() < count) drawIn(ids[lastWithMeasure]);  // what rounding left behind the end
  return out;
}

}  // namespace

std::vector<ErrorSample> samplesOnSurface(std::span<const LatticePoint> points, CellSpan cells,
                                          std::span<const std::uint32_t> ids, std::size_t count,
                                          std::uint64_t seed) {
  return stratified<3>(points, cells, ids, count, seed, areaOf, triangleWeights);
}

std::vector<ErrorSample> samplesInVolume(std::span<const LatticePoint> points, CellSpan cells,
                                         std::size_t count, std::uint64_t seed) {
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < cells.size(); ++i)
    if (cells[i][3] != kGhost) ids.push_back(i);
  return stratified<4>(points, cells, ids, count, seed, volumeOf, tetrahedronWeights);
}

}  // namespace qtet
