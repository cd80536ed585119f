// `qtet simplify -o NAME.json`: a log for each run of steps with the same cells, and their list.
#pragma once

#include <ostream>

#include "proto/segment_list.h"
#include "simplify/commands/simplified_log.h"

namespace qtet {

/// Makes NAME.0.qtet, NAME.1.qtet ... beside the list `request.output`, NAME.json. Each log has an
/// instant of each series at each of its times, also where it has one time. All logs are written
/// under other names first; files of their names are then replaced, and at last the list. So an
/// error before that leaves an older list and its logs as they were. Logs beyond those of the new
/// list stay. Memory holds two steps without fields, and what makeLog holds of a segment. Returns
/// what `qtet simplify --json` prints. Errors: segmentTimes's, makeLog's; not-found (the file has
/// no times), limit-exceeded (kMaxSegments), io.
[[nodiscard]] Result<OrderedJson> makeList(const SimplifyRequest& request, Progress& progress);

/// The same report for people.
void printMadeList(const OrderedJson& report, std::ostream& out);

}  // namespace qtet
