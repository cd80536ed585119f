#include "simplify/cost/field_weights.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <string_view>

namespace qtet {
namespace {

struct SeriesError {
  double sum = 0, instants = 0;

  [[nodiscard]] double mean() const { return std::max(0.0, sum / instants); }
};

double weightOf(double error, double largest) {
  if (largest == 0) return 1;
  const double share = std::sqrt(error / largest);
  return kMaxFieldWeight * share > 1 ? 1 / share : kMaxFieldWeight;
}

}  // namespace

std::vector<double> balancedFieldWeights(std::span<const FieldInfo> fields,
                                         std::span<const CostPart> parts,
                                         std::span<const double> errors) {
  assert(parts.size() == errors.size());
  std::map<std::string_view, SeriesError> series;  // a field without a time is one, too
  const auto seriesOfPart = [&](const CostPart& part) -> SeriesError& {
    return series[fields[part.field].name.withoutTime()];
  };
  for (std::size_t i = 0; i < parts.size(); ++i) {
    SeriesError& its = seriesOfPart(parts[i]);
    its.sum += errors[i], ++its.instants;
  }
  double largest = 0;
  for (const auto& [name, its] : series) largest = std::max(largest, its.mean());
  std::vector<double> weights(fields.size(), 0);
  for (const CostPart& part : parts)
    weights[part.field] = weightOf(seriesOfPart(part).mean(), largest);
  return weights;
}

}  // namespace qtet
