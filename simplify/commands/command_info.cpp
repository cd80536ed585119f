#include "simplify/commands/commands.h"
#include "simplify/commands/list_info.h"
#include "simplify/commands/log_info.h"
#include "simplify/log/opened_list.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/several_logs.h"

namespace qtet {
namespace {

Result<LogReport> listReport(const std::string& list, bool all) {
  Result<OrderedJson> info = listInfo(list);
  if (!info) return std::unexpected(info.error());
  std::string text = listText(*info, list, all ? kMaxSegments : kShownLevels);
  return LogReport{std::move(*info), std::move(text)};
}

CommandHelp infoHelp() {
  return {"info", "info LOG.qtet|LIST.json... [--all] [--json]",
          R"(Says what a log holds: digest, lattice, fields, and for each level its cells and bytes.
Level 0 is the base mesh, the last level the input's mesh; `cumulative` is the length of the file's
prefix that holds a level, `bytes` what it is above that of the row before.
Where the log tells them, the errors against the original follow: of the boundary in per cent of the
diagonal (the worse one of both ways), the volume that is lost and gained in per cent of the
original's, and of each field in per cent of its range: its max is sampled.
Of fields, `within` is how far a value of the last level may be from the input's, in the field's
unit.
--json: digest, generator, source, bytes, headBytes, chunks, lattice {bits, step, origin}, timeUnit,
fields [{name, components, type, association, bits, step, largestRoundingError (0: exact), minimum,
range, missingValues, bytes, unit}], kept, and levels [{level, tetrahedra, vertices,
boundaryTriangles, bytes, cumulativeBytes, error}]; error, as fractions and of some levels only:
boundary {toLevel {mean, max}, toOriginal {mean, max}}, volumeLost, volumeGained, fields [{rms,
max}] in the order of the fields above.
A list of logs shows the times, cells and bytes of each. --json: segments [{log, times, digest,
tetrahedra, vertices, levels, bytes}], instants, timeRange, bytes.
Several files stand under their names, and --json is an array of these objects, with input before
the other members: {input, error} for one that failed. The exit code is the worst of all.)",
          R"(  qtet info fin.qtet
  qtet info remeshed.json
  qtet info fin.qtet --json | jq '.levels[0]'
  qtet info logs/*.qtet
)"};
}

}  // namespace

int runInfo(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()("json", "print one JSON object; of several logs an array")(
      "all", "show every level and field, not 20 and 10 of them");
  const ParsedWords parsed(words, infoHelp(), options, {"LOG..."});
  if (parsed.helped(console)) return kExitOk;
  const bool all = parsed.has("all");
  const auto report = [&](const std::string& path) {
    return isSegmentList(path) ? listReport(path, all) : logReport(path, all, console.colours);
  };
  return reportLogs(parsed, report, console);
}

}  // namespace qtet
