// Makes a log of a mesh file and reports on it: the whole of `qtet simplify`, or one log of a list.
#pragma once

#include <ostream>
#include <string>

#include "simplify/commands/output.h"
#include "simplify/commands/progress.h"
#include "simplify/pipeline/pipeline.h"
#include "simplify/read/options/read_options.h"

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

/// The same report for people.
void printMadeLog(const OrderedJson& report, std::ostream& out);

}  // namespace qtet
