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

/// The log of a mesh that takes more memory than is free ends at so many cells, unless somebody
/// says how many. A viewer in a browser holds them.
inline constexpr std::size_t kDefaultFinest = 16'000'000;
/// Bytes of `memory` at least: those of a block and of what is read of it.
inline constexpr std::uint64_t kLeastMemory = 1'000'000'000;
/// How many cells the log of a mesh may end at where so many bytes are to suffice.
[[nodiscard]] std::size_t finestWithin(std::uint64_t memory);

/// Makes the log and writes it to `output`. Returns what `qtet simplify --json` prints. Errors:
/// chosenTimesOf's, readMesh's, simplifyToLog's, simplifySeries's, writeLog's.
[[nodiscard]] Result<OrderedJson> makeLog(const SimplifyRequest& request, const Output& output,
                                          Progress& progress);

}  // namespace qtet
