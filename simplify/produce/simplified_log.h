// Makes a log of a mesh file: the whole of `qtet simplify`, or one log of a list.
#pragma once

#include <string>

#include "simplify/pipeline/pipeline.h"
#include "simplify/read/options/read_options.h"
#include "simplify/words/json_report.h"
#include "simplify/words/output.h"
#include "simplify/words/progress.h"

namespace qtet {

struct SimplifyRequest {
  std::string input;
  std::string output;  ///< as it stands in reports and messages
  ReadOptions read;
  PipelineOptions pipeline;
};

/// Makes the log and writes it to `output`. Returns what `qtet simplify --json` prints. Errors:
/// chosenTimesOf's, readMesh's, simplifyToLog's, simplifySeries's, writeLog's.
[[nodiscard]] Result<OrderedJson> makeLog(const SimplifyRequest& request, const Output& output,
                                          Progress& progress);

}  // namespace qtet
