// The reports of `info` and `verify` on one log, or on each of several.
#pragma once

#include <functional>
#include <string>

#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"

namespace qtet {

/// All that is said about a log.
struct LogReport {
  OrderedJson json;
  std::string text;
};
using LogReporter = std::function<Result<LogReport>(const std::string& path)>;

/// Reports on each word of "LOG..." in order, and goes on after a failure. Prints the text, or with
/// --json the object. If there are several, each text stands under its name. With --json they are
/// one array of objects whose first member is `input`; a failure gives {input, error}. Returns the
/// worst exit code of all.
[[nodiscard]] int reportLogs(const ParsedWords& parsed, const LogReporter& report,
                             Console& console);

}  // namespace qtet
