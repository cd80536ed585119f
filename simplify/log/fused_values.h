// The values of a log's fused vertices, for fields that come to the log later
// (SERIES.md, "Fields added later").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "codec/refine/log_history.h"

namespace qtet {

/// Values of all of the history's vertices from those of the last level's, `components` integers
/// each. A fused vertex has the value for which the cost is least at its place (ALGORITHM.md,
/// "Cost"). It is within the range of the last level's values.
/// `finest`: the last level's cells.
[[nodiscard]] std::vector<std::int32_t> fusedValues(const LogHistory& log,
                                                    std::span<const Tetrahedron> finest,
                                                    std::vector<std::int32_t> values,
                                                    std::uint32_t components);

}  // namespace qtet
