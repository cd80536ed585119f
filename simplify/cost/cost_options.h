// The options that a caller has for a fusion's cost (ALGORITHM.md, "Cost").
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace qtet {

/// The interfaces of a cell field of one component.
struct LabelCost {
  std::size_t field = 0;
  double weight = 0;  ///< as CostOptions::boundaryWeight
};

/// LabelCost::weight where nobody gives one: a sixteenth of the boundary's, at least 0.01. More
/// takes cells from the fields, but makes labels hardly better: the steps of an interface between
/// cells are wrong then, which fusing smooths.
[[nodiscard]] inline double labelWeightBeside(double boundaryWeight) {
  return std::max(boundaryWeight / 16, 0.01);
}

struct CostOptions {
  /// One a field: what its squared error, over its range, counts. 0 leaves it out; so does a
  /// constant field. Empty: 1 for each point field of floats (field_weights.h has better ones).
  std::vector<double> fieldWeights;
  /// The weight of the boundary's squared distance beside the fields, with areas and distances over
  /// the mesh's diagonal. Without: balancedBoundaryWeight (boundary_weight.h).
  std::optional<double> boundaryWeight;
  /// The weights of labels. Without fields in the cost those of a weight above 0
  /// count like the boundary.
  std::vector<LabelCost> labels{};
  /// Without fields: how many times its area a boundary plane counts, the paper's "weighted planar
  /// quadric error metrics".
  double boundaryFactor = 10;
};

}  // namespace qtet
