// Decides which fields the cost of a fusion counts, and in what unit (ALGORITHM.md, "Cost").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

/// A field that counts.
struct CostPart {
  std::size_t field = 0;
  double scale = 1;  ///< from the field's integers to the unit of residuals
};

/// One a field, 1 where all of its integers are equal.
[[nodiscard]] std::vector<std::uint8_t> oneValueOf(const LatticeMesh& mesh);

/// `isOneValue` is oneValueOf, `weights` is CostOptions::fieldWeights.
[[nodiscard]] std::vector<CostPart> costPartsOf(std::span<const FieldInfo> fields,
                                                std::span<const std::uint8_t> isOneValue,
                                                std::span<const double> weights);
[[nodiscard]] inline std::vector<CostPart> costPartsOf(const LatticeMesh& mesh,
                                                       std::span<const double> weights) {
  return costPartsOf(mesh.fields, oneValueOf(mesh), weights);
}

}  // namespace qtet
