#include "simplify/cost/cost_parts.h"

#include <algorithm>
#include <cmath>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

std::vector<std::uint8_t> oneValueOf(const LatticeMesh& mesh) {
  std::vector<std::uint8_t> out;
  for (const std::vector<std::int32_t>& values : mesh.values)
    out.push_back(std::ranges::all_of(values, [&](std::int32_t v) { return v == values[0]; }));
  return out;
}

std::vector<CostPart> costPartsOf(std::span<const FieldInfo> fields,
                                  std::span<const std::uint8_t> isOneValue,
                                  std::span<const double> weights) {
  std::vector<CostPart> parts;
  std::vector<double> chosen;
  double total = 0;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const FieldInfo& info = fields[f];
    const double weight = weights.empty() ? isFloatType(info.type) : weights[f];
    if (isCellField(info) || weight <= 0 || isOneValue[f]) continue;
    parts.push_back({f, 1});
    chosen.push_back(weight);
    total += weight;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const FieldInfo& info = fields[parts[i].field];
    // A vector takes the larger of its lengths' range and its components' range: directions may
    // turn while their lengths stay.
    const double extent = info.step * (std::ldexp(1.0, info.bits) - 1);
    const double range = info.components == 1 ? info.range[1] - info.range[0]
                                              : std::max(info.range[1] - info.range[0], extent);
    const double steps = (range > 0 ? range : extent) / info.step;
    parts[i].scale = std::sqrt(chosen[i] / total) / steps;
  }
  return parts;
}

}  // namespace qtet
