// The values of a log's fused vertices, for fields that come to the log later
// (SERIES.md, "Fields added later").
#pragma once

#include <cstdint>
#include <vector>

#include "codec/refine/log_history.h"

namespace qtet {

/// Values of all of the history's vertices from those of the last level's, `components` integers
/// each. A fused vertex has the value that follows from its prey by the usual curvature
/// (VALUES.md, "Lifted blocks"), so that a log tells no correction.
[[nodiscard]] std::vector<std::int32_t> fusedValues(const LogHistory& log,
                                                    std::vector<std::int32_t> values,
                                                    std::uint32_t components);

}  // namespace qtet
