#include "simplify/log/opened_list.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "codec/files/unreachable.h"
#include "proto/number_text.h"
#include "proto/series.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// At most one byte more than a list may have.
Result<std::string> textOf(const fs::path& path) {
  std::error_code code;
  const bool isThere = fs::exists(path, code);
  if (isUnreachable(code))
    return fail(ErrorCode::kIo, "cannot read " + path.string() + ": " + code.message());
  if (!isThere)
    return fail(ErrorCode::kNotFound,
                "there is no list " + path.string() + "; 'qtet simplify -o NAME.json' makes one");
  std::string out(kMaxListBytes + 1, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!fs::is_regular_file(path, code) || !file)
    return fail(ErrorCode::kIo, path.string() + " cannot be read; is it a file that you may read?");
  file.read(out.data(), static_cast<std::streamsize>(out.size()));
  out.resize(static_cast<std::size_t>(file.gcount()));
  return out;
}

}  // namespace

bool isSegmentList(const fs::path& path) { return path.extension() == kListEnding; }

Result<SegmentList> openList(const fs::path& path) {
  const Result<std::string> text = textOf(path);
  if (!text) return std::unexpected(text.error());
  Result<SegmentList> out = readSegmentList(*text);
  if (!out)
    return fail(out.error().code, path.string() + ": " + out.error().message +
                                      "; this is no list of logs, or it is damaged: 'qtet "
                                      "simplify -o NAME.json' makes one");
  return out;
}

std::vector<double> instantTimes(const Manifest& manifest) {
  std::vector<double> out;
  for (const ManifestField& field : manifest.fields)
    if (const auto name = field.name.instant()) out.push_back(name->time);
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::string timesText(std::span<const double> times) {
  std::string out;
  for (const double time : times) out += (out.empty() ? "" : ",") + shortestText(time);
  return out;
}

Result<OpenedLog> openSegment(const fs::path& list, const Segment& segment) {
  const fs::path path = list.parent_path() / segment.log;
  std::error_code code;
  if (!fs::exists(path, code) && !isUnreachable(code))
    return fail(ErrorCode::kNotFound, list.string() + " names the log " + segment.log +
                                          ", which is not beside it; copy the list together with "
                                          "its logs, or make both again");
  Result<OpenedLog> log = openLog(path);
  if (!log) {
    log.error().message = list.string() + " names it: " + log.error().message;
    return log;
  }
  const std::vector<double> instants = instantTimes(log->manifest);
  for (const double time : segment.times) {
    if (!instants.empty() && !placeOfTime(instants, time))
      return fail(ErrorCode::kNotFound, list.string() + ": the log " + segment.log +
                                            " has no instant at time " + shortestText(time) +
                                            ", which the list names; one of them belongs to "
                                            "another series: make both again");
  }
  return log;
}

}  // namespace qtet
