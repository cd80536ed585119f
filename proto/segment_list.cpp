#include "proto/segment_list.h"

#include <limits>
#include <optional>

#include "proto/json_reader.h"
#include "proto/limits.h"

namespace qtet {
namespace {

constexpr std::string_view kKind = "series";
constexpr std::string_view kLogEnding = ".qtet";

/// The times of one segment, which lie behind `last`.
std::vector<double> timesOf(const JsonCursor& json, double& last) {
  std::vector<double> out;
  for (const JsonCursor& item : json.items(1, kMaxListBytes)) {
    const double time = item.number();
    if (time <= last) item.fail("must be later than the time before it");
    out.push_back(time);
    last = time;
  }
  return out;
}

std::string logOf(const JsonCursor& json) {
  std::string out = json.text(kMaxNameBytes);
  if (json.present() && !isSegmentLog(out))
    json.fail("must be the name of a log beside the list, without a path, that ends in .qtet");
  return out;
}

SegmentList listOf(const JsonCursor& json) {
  SegmentList out;
  if (json["qtet"].text(kMaxNameBytes) != kKind)
    json["qtet"].fail("must be \"series\", as in a list of logs");
  double last = -std::numeric_limits<double>::infinity();
  for (const JsonCursor& segment : json["segments"].items(1, kMaxSegments)) {
    std::string log = logOf(segment["log"]);
    out.segments.push_back({std::move(log), timesOf(segment["times"], last)});
  }
  return out;
}

std::unexpected<Error> tooMany(const std::string& what, std::size_t most) {
  return fail(ErrorCode::kLimitExceeded, "a list of logs has at most " + std::to_string(most) +
                                             " " + what + "; make lists of shorter ranges");
}

}  // namespace

std::vector<double> SegmentList::times() const {
  std::vector<double> out;
  for (const Segment& segment : segments)
    out.insert(out.end(), segment.times.begin(), segment.times.end());
  return out;
}

bool isSegmentLog(std::string_view name) {
  return name.size() > kLogEnding.size() && name.ends_with(kLogEnding) &&
         name.find_first_of(std::string_view("/\\\0", 3)) == std::string_view::npos &&
         name.find("..") == std::string_view::npos;
}

Result<SegmentList> readSegmentList(std::string_view text) {
  if (text.size() > kMaxListBytes) return tooMany("bytes", kMaxListBytes);
  if (!isShallowJson(text)) return fail(ErrorCode::kBadValue, "its arrays are nested too deeply");
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return fail(ErrorCode::kBadValue, "it is no JSON");
  const auto segments = json.is_object() ? json.find("segments") : json.end();
  if (segments != json.end() && segments->is_array() && segments->size() > kMaxSegments)
    return tooMany("segments", kMaxSegments);
  std::optional<Error> error;
  SegmentList out = listOf(JsonCursor(&json, "", &error));
  if (error) return std::unexpected(*error);
  return out;
}

Result<std::string> segmentListText(const SegmentList& list) {
  std::string out = "{\n  \"qtet\": \"series\",\n  \"segments\": [";
  for (const Segment& segment : list.segments) {
    const bool isFirst = &segment == &list.segments.front();
    out += std::string(isFirst ? "" : ",") + "\n    {\"log\": " + dumpJson(segment.log) +
           ", \"times\": " + dumpJson(segment.times) + "}";
  }
  out += "\n  ]\n}\n";
  if (const Result<SegmentList> read = readSegmentList(out); !read)
    return std::unexpected(read.error());
  return out;
}

}  // namespace qtet
