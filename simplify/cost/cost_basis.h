// The values in the cost (ALGORITHM.md, "Many fields"): the components of the fields themselves or,
// where these are many, the few directions in which they vary together.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "simplify/cost/cost_parts.h"

namespace qtet {

/// Most values in the cost; each adds 40 bytes a vertex.
inline constexpr std::size_t kMaxCostComponents = 32;

/// The values of one vertex in the cost, components() of them.
using CostValues = std::array<double, kMaxCostComponents>;

class CostBasis {
 public:
  /// Up to kMaxCostComponents components of `parts` stand for themselves. With more of them, the
  /// cost takes orthonormal directions that hold kVarianceKept of the components' variance, scaled
  /// as in `parts`. If that takes too many, there are kMaxCostComponents. REQUIRES: `parts` of
  /// point fields of `mesh`.
  CostBasis(const LatticeMesh& mesh, std::span<const CostPart> parts);

  /// Values in the cost.
  [[nodiscard]] std::size_t components() const { return components_; }
  /// Whether the fields' components stand for themselves.
  [[nodiscard]] bool isDirect() const { return directions_.empty(); }
  /// The share of the scaled field components' variance that the values hold; 1 if isDirect().
  [[nodiscard]] double varianceKept() const { return varianceKept_; }

  /// Adds `value`, the scaled component number `i` of all parts, to the values that it is part of.
  void add(std::size_t i, double value, std::span<double> values) const;
  /// The change of the scaled component number `i` with the values. REQUIRES: !isDirect().
  [[nodiscard]] double changeOf(std::size_t i, std::span<const double> values) const;

 private:
  std::size_t components_ = 0;
  double varianceKept_ = 1;
  std::vector<double> directions_;  // components_ for each component of the fields
};

}  // namespace qtet
