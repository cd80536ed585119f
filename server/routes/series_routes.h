// The address of a series at a point: `series?x=&y=&z=&field=[&level=|&error=][&format=]`
// (PROTOCOL.md, "Values over time").
#pragma once

#include "server/routes/level_routes.h"

namespace qtet {

/// The rms error, a fraction of a field's range, where the request names none. A plot hardly shows
/// it, and the level is mostly a small part of the log.
inline constexpr double kDefaultSeriesError = 0.01;

/// The answer to `/v1/logs/{sha256}/series`: values to be made, or 304, 400, 404 or 412.
[[nodiscard]] Answer routeSeries(const RequestView& request, const RequestTarget& target,
                                 const NamedLog& log);

}  // namespace qtet
