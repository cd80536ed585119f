#include "simplify/measure/original_samples.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace qtet {
namespace {

std::vector<std::uint8_t> usedBy(CellSpan cells, std::size_t points) {
  std::vector<std::uint8_t> out(points, 0);
  for (const auto& cell : cells)
    for (const VertexId v : cell) out[v] = 1;
  return out;
}

}  // namespace

SampledPlaces placesOf(std::span<const LatticePoint> points, CellSpan cells,
                       const SampleCounts& counts, std::uint64_t seed) {
  SampledPlaces out;
  out.places = samplesInVolume(points, cells, counts.volume, seed);
  out.uniform = out.places.size();
  if (counts.vertices == 0) return out;
  std::vector<std::uint8_t> isNew = usedBy(cells, points.size());
  const auto vertices = static_cast<std::size_t>(std::ranges::count(isNew, std::uint8_t{1}));
  const std::size_t step = vertices / counts.vertices + 1;
  std::size_t met = 0;
  for (std::uint32_t id = 0; id < cells.size(); ++id)
    for (std::size_t i = 0; i < 4; ++i) {
      const VertexId v = cells[id][i];
      if (std::exchange(isNew[v], std::uint8_t{0}) == 0 || met++ % step != 0) continue;
      out.places.push_back({toVector(points[v]), id, {}});
      out.places.back().weights[i] = 1;
    }
  return out;
}

std::vector<double> rangesOf(std::span<const FieldInfo> fields,
                             std::span<const std::vector<std::int32_t>> values, CellSpan cells,
                             std::size_t points) {
  const std::vector<std::uint8_t> isUsed = usedBy(cells, points);
  std::vector<double> out;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const std::size_t components = fields[f].components;
    const bool ofCells = isCellField(fields[f]);
    double squared = 0;
    for (std::size_t c = 0; c < components; ++c) {
      std::int32_t low = std::numeric_limits<std::int32_t>::max(),
                   high = std::numeric_limits<std::int32_t>::min();
      for (std::size_t i = 0; i < (ofCells ? values[f].size() / components : points); ++i) {
        if (!ofCells && !isUsed[i]) continue;
        low = std::min(low, values[f][i * components + c]);
        high = std::max(high, values[f][i * components + c]);
      }
      assert(low <= high);
      const double range = static_cast<double>(high) - static_cast<double>(low);
      squared += range * range;
    }
    out.push_back(std::sqrt(squared));
  }
  return out;
}

}  // namespace qtet
