// `qtet simplify -o NAME.json`: a log for each run of steps with the same cells, and their list.
#pragma once

#include <ostream>

#include "proto/segment_list.h"
#include "simplify/produce/simplified_log.h"
#include "simplify/words/json_report.h"

namespace qtet {

/// Makes NAME.0.DIGEST.qtet, NAME.1.DIGEST.qtet ... beside the list `request.output`, NAME.json.
/// DIGEST is the first twelve digits of the log's own. Each log has an instant of each series at
/// each of its times, also where it has one time. The logs get their names when all are made, and
/// then the list is written. So an older list and its logs stay whole until then, also where the
/// process is killed. Then the older logs go. Memory holds two steps without fields, and what
/// makeLog holds of a segment. Returns what `qtet simplify --json` prints. Errors: segmentTimes's,
/// makeLog's; not-found (the file has no times), limit-exceeded (kMaxSegments), io.
[[nodiscard]] Result<OrderedJson> makeList(const SimplifyRequest& request, Progress& progress);

/// The same report for people.
void printMadeList(const OrderedJson& report, std::ostream& out);

}  // namespace qtet
