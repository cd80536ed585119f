// `qtet info NAME.json`: what a list of logs holds.
#pragma once

#include <string>

#include "simplify/words/json_report.h"

namespace qtet {

/// {segments: [{log, times, digest, tetrahedra, vertices, levels, bytes}], instants, timeRange,
/// bytes}. Opens one log after the other. Errors: openList's, openSegment's.
[[nodiscard]] Result<OrderedJson> listInfo(const std::string& list);

/// The same for people, a line a segment. `most`: of more segments only so many are shown.
[[nodiscard]] std::string listText(const OrderedJson& info, const std::string& list,
                                   std::size_t most);

}  // namespace qtet
