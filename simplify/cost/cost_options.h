// The options that a caller has for a fusion's cost (ALGORITHM.md, "Cost").
#pragma once

#include <optional>
#include <vector>

namespace qtet {

struct CostOptions {
  /// One a field: what its squared error, over its range, counts. 0 leaves it out; so does a
  /// constant field. Empty: 1 for each point field of floats.
  std::vector<double> fieldWeights;
  /// The weight of the boundary's squared distance beside the fields, with areas and distances over
  /// the mesh's diagonal. Without: balancedBoundaryWeight (boundary_weight.h).
  std::optional<double> boundaryWeight;
  /// Without fields: how many times its area a boundary plane counts, the paper's "weighted planar
  /// quadric error metrics".
  double boundaryFactor = 10;
};

}  // namespace qtet
