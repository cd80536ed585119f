// `qtet verify`: every check of a log or of a list of logs, also against the input.
#pragma once

#include <optional>
#include <string>

#include "simplify/read/options/read_options.h"
#include "simplify/words/json_report.h"
#include "simplify/words/progress.h"

namespace qtet {

/// The mesh that a log was made from.
struct ComparedInput {
  std::string path;
  ReadOptions options;
};

/// Returns the JSON that `qtet verify` prints. Errors: openLog's, decodeVerified's, readMesh's,
/// sameMesh's, compareKept's.
[[nodiscard]] Result<OrderedJson> verifyLog(const std::string& path,
                                            std::optional<ComparedInput> input, Progress& progress);

/// The same for each log of a list, against the steps of the input at the segment's times.
[[nodiscard]] Result<OrderedJson> verifyList(const std::string& path,
                                             std::optional<ComparedInput> input,
                                             Progress& progress);

}  // namespace qtet
