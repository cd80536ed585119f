// Decides which fields the cost of a fusion counts, and in what unit (ALGORITHM.md, "Cost").
#pragma once

#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

/// A field that counts.
struct CostPart {
  std::size_t field = 0;
  double scale = 1;  ///< from the field's integers to the unit of residuals
};

/// `weights` is CostOptions::fieldWeights.
[[nodiscard]] std::vector<CostPart> costPartsOf(const LatticeMesh& mesh,
                                                std::span<const double> weights);

}  // namespace qtet
