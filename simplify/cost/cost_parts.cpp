#include "simplify/cost/cost_parts.h"

#include <algorithm>
#include <cmath>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

std::vector<CostPart> costPartsOf(const LatticeMesh& mesh, std::span<const double> weights) {
  std::vector<CostPart> parts;
  std::vector<double> chosen;
  double total = 0;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const FieldInfo& info = mesh.fields[f];
    const double weight = weights.empty() ? isFloatType(info.type) : weights[f];
    const auto [low, high] = std::ranges::minmax(mesh.values[f]);
    if (isCellField(info) || weight <= 0 || low == high) continue;
    parts.push_back({f, 1});
    chosen.push_back(weight);
    total += weight;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const FieldInfo& info = mesh.fields[parts[i].field];
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
