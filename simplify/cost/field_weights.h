// The weights of fields in the cost where nobody gives them (ALGORITHM.md, "Cost").
#pragma once

#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "simplify/cost/cost_parts.h"

namespace qtet {

/// The most that a field counts beside one that counts 1.
inline constexpr double kMaxFieldWeight = 8;

/// Weights that fall with the root of each field's expected mean square error, in all fields of
/// `parts`; 0 elsewhere. The field of the largest error counts 1, and none over kMaxFieldWeight.
/// The instants of a series count alike, by the mean of their errors. `errors` are
/// expectedFieldErrors of `parts`. REQUIRES: the parts' scales are those of equal weights.
/// (Measured: by the squared errors themselves, rough fields lose up to a fifth more where the
/// shape limits the smooth ones.)
[[nodiscard]] std::vector<double> balancedFieldWeights(std::span<const FieldInfo> fields,
                                                       std::span<const CostPart> parts,
                                                       std::span<const double> errors);

}  // namespace qtet
