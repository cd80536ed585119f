// The report of `qtet simplify` on a log that it made.
#pragma once

#include <ostream>

#include "simplify/pipeline/pipeline.h"
#include "simplify/produce/simplified_log.h"
#include "simplify/produce/written_log.h"
#include "simplify/words/json_report.h"

namespace qtet {

/// Returns the JSON that `qtet simplify` prints. The counts are those of the bytes written, not of
/// what was meant to be written. `seconds`: of each stage, by name.
[[nodiscard]] OrderedJson madeLogReport(const SimplifyRequest& request, const ReadReport& read,
                                        const PipelineReport& from, const WrittenLog& written,
                                        const OrderedJson& seconds);

/// The same report for people.
void printMadeLog(const OrderedJson& report, std::ostream& out);

}  // namespace qtet
