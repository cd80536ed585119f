#include "simplify/commands/simplified_list.h"

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "codec/files/atomic_file.h"
#include "proto/field_key.h"
#include "proto/number_text.h"
#include "proto/text_bytes.h"
#include "proto/utf8.h"
#include "simplify/log/opened_list.h"
#include "simplify/read/read_mesh.h"
#include "simplify/read/read_segments.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

/// The logs of a list that is not published yet. They lie beside it under other names, which are
/// removed with the object.
class UnpublishedLogs {
 public:
  explicit UnpublishedLogs(const fs::path& list)
      : folder_(list.parent_path()), stem_(list.stem().string()) {}
  UnpublishedLogs(const UnpublishedLogs&) = delete;
  UnpublishedLogs& operator=(const UnpublishedLogs&) = delete;
  ~UnpublishedLogs() {
    std::error_code ignored;
    for (std::size_t i = 0; i < count_; ++i) fs::remove(fileOf(i), ignored);
  }

  /// Where the next log is written.
  [[nodiscard]] fs::path next() { return fileOf(count_++); }
  /// The name of a log when it is published.
  [[nodiscard]] std::string nameOf(std::size_t log) const {
    return stem_ + "." + std::to_string(log) + ".qtet";
  }
  /// Gives all logs their names.
  [[nodiscard]] Status publish() const {
    for (std::size_t i = 0; i < count_; ++i) {
      std::error_code code;
      fs::rename(fileOf(i), folder_ / nameOf(i), code);
      if (code)
        return fail(ErrorCode::kIo,
                    "cannot write " + (folder_ / nameOf(i)).string() + ": " + code.message());
    }
    return {};
  }

 private:
  [[nodiscard]] fs::path fileOf(std::size_t log) const {
    return folder_ / ("." + nameOf(log) + ".part");
  }

  fs::path folder_;
  std::string stem_;
  std::size_t count_ = 0;
};

/// "0,0.1,0.2"
std::string timesText(const std::vector<double>& times) {
  std::string out;
  for (const double time : times) out += (out.empty() ? "" : ",") + shortestText(time);
  return out;
}

bool hasInstants(const TetMesh& mesh) {
  return std::ranges::any_of(
      mesh.fields, [](const MeshField& field) { return instantName(field.name).has_value(); });
}

/// Checks before the work whether the log of an input without known times will have instants.
Status checkInstants(const std::string& input, const ReadOptions& options) {
  ReadOptions read = options;
  read.namesTime = true;
  const Result<ReadMesh> asked = readMesh(input, read);
  if (!asked) return std::unexpected(asked.error());
  if (hasInstants(asked->mesh)) return {};
  read.time = "all";
  const Result<ReadMesh> all = readMesh(input, read);
  if (all && hasInstants(all->mesh))
    return fail(ErrorCode::kBadValue, input +
                                          " has several times, but `time` chooses one of them, "
                                          "which needs no list of logs; give --time all, or -o "
                                          "NAME.qtet");
  return fail(ErrorCode::kNotFound,
              input + " has no times, which a list of logs needs; give -o NAME.qtet");
}

std::unexpected<Error> otherTimes(const std::string& input, const std::vector<double>& asked,
                                  const std::vector<double>& found) {
  return fail(ErrorCode::kBadInput, input + " gave the times " + timesText(found) +
                                        " where it was asked for " + timesText(asked) +
                                        "; a list needs a step at each of its times: choose others "
                                        "with `time`");
}

Status checkCount(std::size_t segments, const std::string& input) {
  if (segments <= kMaxSegments) return {};
  return fail(ErrorCode::kLimitExceeded,
              input + ": its cells change so often that it would be " + std::to_string(segments) +
                  " logs, but a list has at most " + std::to_string(kMaxSegments) +
                  "; choose fewer steps with `time`");
}

/// A list refers to its logs by name, in JSON.
Status checkName(const std::string& log, const std::string& output) {
  if (isSegmentLog(log) && isUtf8(log)) return {};
  return fail(ErrorCode::kBadValue, output + ": a list cannot refer to a log called " + log +
                                        "; choose a name in UTF-8 without \"..\" and backslashes");
}

/// The segments of the input's steps. A reader that takes all steps at once gives one without
/// times.
Result<std::vector<std::vector<double>>> segmentsOf(const SimplifyRequest& request,
                                                    Progress& progress,
                                                    std::vector<std::string>& notes) {
  progress.stage("comparing the cells of the steps of " + request.input);
  auto out = segmentTimes(
      request.input, request.read, [&](double fraction) { progress.update(fraction); }, notes);
  if (!out) return out;
  if (Status checked = checkCount(out->size(), request.input); !checked)
    return std::unexpected(checked.error());
  if (!out->empty()) return out;
  if (Status checked = checkInstants(request.input, request.read); !checked)
    return std::unexpected(checked.error());
  out->emplace_back();
  return out;
}

/// Makes the log of one segment, and puts it into the list and the report.
Status addSegment(const SimplifyRequest& request, std::vector<double> times, UnpublishedLogs& logs,
                  Progress& progress, SegmentList& list, OrderedJson& report) {
  const std::string name = logs.nameOf(list.segments.size());
  SimplifyRequest ofOne = request;
  ofOne.output = (fs::path(request.output).parent_path() / name).string();
  ofOne.read.namesTime = true;
  if (!times.empty()) ofOne.read.time = timesText(times);
  const fs::path file = logs.next();
  Result<OrderedJson> made = makeLog(ofOne, file, progress);
  if (!made) return std::unexpected(made.error());
  const Result<OpenedLog> log = openLog(file);
  if (!log) return std::unexpected(log.error());
  const std::vector<double> found = instantTimes(log->manifest);
  if (times.empty()) times = found;
  // a log without instants holds for all times of its segment
  if (!found.empty() && found != times) return otherTimes(request.input, times, found);
  for (const char* texts : {"notes", "warnings"})
    for (const OrderedJson& text : (*made)[texts])
      if (std::ranges::find(report[texts], text) == report[texts].end())
        report[texts].push_back(text);
  report["segments"].push_back({{"log", name}, {"times", times}, {"made", std::move(*made)}});
  list.segments.push_back({name, std::move(times)});
  return {};
}

}  // namespace

Result<OrderedJson> makeList(const SimplifyRequest& request, Progress& progress) {
  UnpublishedLogs logs(request.output);
  if (Status checked = checkName(logs.nameOf(0), request.output); !checked)
    return std::unexpected(checked.error());
  std::vector<std::string> notes;
  auto segments = segmentsOf(request, progress, notes);
  if (!segments) return std::unexpected(segments.error());
  OrderedJson report = {{"input", request.input},          {"output", request.output},
                        {"times", OrderedJson::array()},   {"segments", OrderedJson::array()},
                        {"notes", withOptionNames(notes)}, {"warnings", OrderedJson::array()}};
  SegmentList list;
  for (std::vector<double>& times : *segments)
    if (Status s = addSegment(request, std::move(times), logs, progress, list, report); !s)
      return std::unexpected(s.error());
  const Result<std::string> text = segmentListText(list);
  if (!text)
    return fail(
        text.error().code,
        request.output + ": its list of logs is none that can be read: " + text.error().message);
  report["times"] = list.times();
  if (Status s = logs.publish(); !s) return std::unexpected(s.error());
  if (Status s = writeFileAtomically(request.output, viewOf(*text)); !s)
    return std::unexpected(s.error());
  return report;
}

void printMadeList(const OrderedJson& report, std::ostream& out) {
  for (const OrderedJson& segment : report["segments"]) printMadeLog(segment["made"], out);
  const OrderedJson& times = report["times"];
  out << printable(report["output"].get<std::string>()) << ": "
      << counted(report["segments"].size(), "log", "logs") << ", "
      << counted(times.size(), "instant", "instants") << ", "
      << shortestText(times.front().get<double>()) << " to "
      << shortestText(times.back().get<double>()) << "\n";
}

}  // namespace qtet
