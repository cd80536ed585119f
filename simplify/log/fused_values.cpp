#include "simplify/log/fused_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/mesh/predicates.h"
#include "simplify/mesh/vector3.h"

namespace qtet {
namespace {

/// For each vertex of the last level, a quarter of the volume of its cells. A fused vertex stands
/// for the sum of its prey's volumes.
std::vector<double> volumesOf(const LogHistory& log) {
  const FusionHistory& h = log.history;
  std::vector<Tetrahedron> cells(h.cells.begin(), h.cells.begin() + log.tetrahedra);
  for (auto fusion = h.fusions.rbegin(); fusion != h.fusions.rend(); ++fusion)
    for (std::uint64_t i = fusion->firstAffected; i < fusion->firstAffected + fusion->affectedCount;
         ++i)
      if (h.affectedCells[i] < log.tetrahedra)
        std::ranges::replace(cells[h.affectedCells[i]], fusion->fused,
                             fusion->prey[h.affectedLabels[i]]);
  std::vector<double> out(h.points.size(), 0.0);
  for (const Tetrahedron& t : cells) {
    const double volume = std::fabs(static_cast<double>(
        volume6(h.points[t[0]], h.points[t[1]], h.points[t[2]], h.points[t[3]])));
    for (const VertexId v : t) out[v] += volume;
  }
  for (const Fusion& fusion : h.fusions)
    for (std::size_t i = 0; i < fusion.k; ++i) out[fusion.fused] += out[fusion.prey[i]];
  return out;
}

/// How much each prey vertex counts in the fused vertex's value. Values by the place on the edge
/// fit the prediction along the step. On comb they take 20 % fewer bytes than the mean by volume,
/// for 10 % more rms error of the base mesh. The nearest prey's value is worse in both.
std::array<double, 4> sharesOf(const Fusion& fusion, const FusionHistory& h,
                               const std::vector<double>& volumes) {
  std::array<double, 4> out{};
  if (fusion.k == 2) {
    const Vector3 a = toVector(h.points[fusion.prey[0]]),
                  step = toVector(h.points[fusion.prey[1]]) - a;
    const double length = dot(step, step);
    const double along =
        length > 0 ? std::clamp(dot(toVector(h.points[fusion.fused]) - a, step) / length, 0.0, 1.0)
                   : 0.5;
    return {1 - along, along};
  }
  double sum = 0;
  for (std::size_t i = 0; i < fusion.k; ++i) sum += volumes[fusion.prey[i]];
  for (std::size_t i = 0; i < fusion.k; ++i)
    out[i] = sum > 0 ? volumes[fusion.prey[i]] / sum : 1.0 / fusion.k;
  return out;
}

}  // namespace

FusedValues::FusedValues(const LogHistory& log) : log_(log) {
  const std::vector<double> volumes = volumesOf(log);
  for (const Fusion& fusion : log.history.fusions)
    shares_.push_back(sharesOf(fusion, log.history, volumes));
}

std::vector<std::int32_t> FusedValues::of(std::vector<std::int32_t> values,
                                          std::uint32_t components) const {
  const std::size_t n = components;
  values.resize(log_.history.points.size() * n);
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    const Fusion& fusion = log_.history.fusions[i];
    for (std::size_t c = 0; c < n; ++c) {
      double value = 0;
      for (std::size_t p = 0; p < fusion.k; ++p)
        value += shares_[i][p] * values[fusion.prey[p] * n + c];
      values[fusion.fused * n + c] = static_cast<std::int32_t>(std::floor(value + 0.5));
    }
  }
  return values;
}

}  // namespace qtet
