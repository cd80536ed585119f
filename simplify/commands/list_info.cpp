#include "simplify/commands/list_info.h"

#include <utility>
#include <vector>

#include "proto/number_text.h"
#include "simplify/log/opened_list.h"
#include "simplify/words/columns.h"

namespace qtet {
namespace {

OrderedJson segmentJson(const Segment& segment, const OpenedLog& log) {
  const ManifestLevel& finest = log.manifest.levels.back();
  return {{"log", segment.log},
          {"times", segment.times},
          {"digest", log.file.digest()},
          {"tetrahedra", finest.tetrahedra},
          {"vertices", finest.vertices},
          {"levels", log.manifest.levels.size() - 1},
          {"bytes", log.file.bytes().size()}};
}

/// "0 to 0.2", or one time.
std::string rangeText(const OrderedJson& times) {
  const std::string first = shortestText(times.front().get<double>());
  return times.front() == times.back() ? first
                                       : first + " to " + shortestText(times.back().get<double>());
}

}  // namespace

Result<OrderedJson> listInfo(const std::string& list) {
  const Result<SegmentList> read = openList(list);
  if (!read) return std::unexpected(read.error());
  OrderedJson segments = OrderedJson::array();
  std::uint64_t bytes = 0;
  for (const Segment& segment : read->segments) {
    const Result<OpenedLog> log = openSegment(list, segment);
    if (!log) return std::unexpected(log.error());
    bytes += log->file.bytes().size();
    segments.push_back(segmentJson(segment, *log));
  }
  const std::vector<double> times = read->times();
  return OrderedJson{{"segments", std::move(segments)},
                     {"instants", times.size()},
                     {"timeRange", {times.front(), times.back()}},
                     {"bytes", bytes}};
}

std::string listText(const OrderedJson& info, const std::string& list, std::size_t most) {
  const OrderedJson& segments = info["segments"];
  std::vector<std::vector<std::string>> rows{
      {"log", "times", "instants", "tetrahedra", "vertices", "bytes"}};
  for (const OrderedJson& segment : segments) {
    if (rows.size() > most) break;
    rows.push_back({printable(segment["log"].get<std::string>()), rangeText(segment["times"]),
                    std::to_string(segment["times"].size()), grouped(segment["tetrahedra"]),
                    grouped(segment["vertices"]), grouped(segment["bytes"])});
  }
  std::string out = printable(list) + ": " + counted(segments.size(), "log", "logs") + ", " +
                    counted(info["instants"], "instant", "instants") + ", " +
                    rangeText(info["timeRange"]) + ", " + grouped(info["bytes"]) + " bytes\n\n" +
                    columns(rows);
  if (segments.size() > most)
    out += "\n--all shows all " + std::to_string(segments.size()) + " logs\n";
  return out;
}

}  // namespace qtet
