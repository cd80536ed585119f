#include "simplify/produce/simplified_list.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "codec/files/atomic_file.h"
#include "codec/files/temporary_folder.h"
#include "proto/field_name.h"
#include "proto/number_text.h"
#include "proto/text_bytes.h"
#include "proto/utf8.h"
#include "simplify/log/opened_list.h"
#include "simplify/produce/made_log_report.h"
#include "simplify/read/read_mesh.h"
#include "simplify/read/read_segments.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 12;  // of a digest: 48 bits tell two logs of one list apart

/// NAME.N.DIGEST.qtet for the log N of the list NAME.json. A new list's logs so never take the
/// place of an older one's.
std::string logName(const std::string& stem, std::size_t log, std::string_view digest) {
  return stem + "." + std::to_string(log) + "." + std::string(digest.substr(0, kDigits)) + ".qtet";
}

/// Whether logName makes `name` of some digest.
bool isLogName(std::string_view name, const std::string& stem, std::size_t log) {
  constexpr std::size_t kEnd = kDigits + std::string_view(".qtet").size();
  const std::string_view digest = name.substr(name.size() - std::min(name.size(), kEnd), kDigits);
  return name == logName(stem, log, digest) &&
         digest.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// The logs of a list that is being made. They wait in a hidden folder beside it, which goes with
/// the object. If the process is killed, it goes with the next one for this list.
class UnpublishedLogs {
 public:
  explicit UnpublishedLogs(const fs::path& list)
      : beside_(list.has_parent_path() ? list.parent_path() : fs::path(".")),
        stem_(list.stem().string()),
        waiting_(beside_, "." + stem_ + ".qtet-unpublished-") {}

  [[nodiscard]] Status made() const {
    if (!waiting_.path().empty()) return {};
    return fail(ErrorCode::kIo, "cannot make a folder for the logs of " + stem_ + ".json in " +
                                    beside_.string() + ": " + waiting_.failure().message());
  }
  /// Where the next log is written.
  [[nodiscard]] fs::path next() const { return fileOf(names_.size()); }
  /// Takes the log of this digest, which was written there. Returns its name beside the list.
  std::string add(std::string_view digest) {
    return names_.emplace_back(logName(stem_, names_.size(), digest));
  }
  /// Moves the logs beside the list and writes it. Then the logs of the older list go that this one
  /// lacks, but for those that somebody renamed. After an error the moved ones go, unless the list
  /// that is there names them.
  [[nodiscard]] Status publish(const fs::path& list, std::string_view text) const {
    const Result<SegmentList> old = openList(list);
    Names moved;
    Status out = moveBeside(moved);
    const bool allMoved = out.has_value();
    if (allMoved) out = writeFileAtomically(list, viewOf(text));
    std::error_code code;
    if (out) {
      if (old) remove(ownNames(*old), names_);
    } else if (!allMoved || (!fs::exists(list, code) && !code)) {
      remove(moved, {});
    } else if (const Result<SegmentList> now = openList(list)) {
      remove(moved, ownNames(*now));
    }
    return out;
  }

 private:
  using Names = std::vector<std::string>;

  /// Adds to `moved` the names that were not there.
  [[nodiscard]] Status moveBeside(Names& moved) const {
    for (std::size_t log = 0; log < names_.size(); ++log) {
      const fs::path file = beside_ / names_[log];
      std::error_code code;
      const bool isThere = fs::exists(file, code);
      fs::rename(fileOf(log), file, code);
      if (code)
        return fail(ErrorCode::kIo, "cannot write " + file.string() + ": " + code.message());
      if (!isThere) moved.push_back(names_[log]);
    }
    return {};
  }
  /// The logs of a list whose names are as this one would give them.
  [[nodiscard]] Names ownNames(const SegmentList& list) const {
    Names out;
    for (std::size_t log = 0; log < list.segments.size(); ++log)
      if (isLogName(list.segments[log].log, stem_, log)) out.push_back(list.segments[log].log);
    return out;
  }
  void remove(const Names& names, const Names& kept) const {
    std::error_code ignored;
    for (const std::string& name : names)
      if (std::ranges::find(kept, name) == kept.end()) fs::remove(beside_ / name, ignored);
  }
  [[nodiscard]] fs::path fileOf(std::size_t log) const {
    return waiting_.path() / (std::to_string(log) + ".qtet");
  }

  fs::path beside_;
  std::string stem_;
  TemporaryFolder waiting_;
  Names names_;
};

bool hasInstants(const TetMesh& mesh) {
  return std::ranges::any_of(mesh.fields,
                             [](const MeshField& field) { return field.name.isInstant(); });
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
  SimplifyRequest ofOne = request;
  ofOne.read.namesTime = true;
  ofOne.pipeline.opensAtFirst = true;
  if (!times.empty()) ofOne.read.time = timesText(times);
  const fs::path file = logs.next();
  Result<OrderedJson> made = makeLog(ofOne, Output{file}, progress);
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
  const std::string name = logs.add(log->file.digest());
  (*made)["output"] = (fs::path(request.output).parent_path() / name).string();
  report["segments"].push_back({{"log", name}, {"times", times}, {"made", std::move(*made)}});
  list.segments.push_back({name, std::move(times)});
  return {};
}

}  // namespace

Result<OrderedJson> makeList(const SimplifyRequest& request, Progress& progress) {
  const std::string sample =
      logName(fs::path(request.output).stem().string(), 0, std::string(kDigits, '0'));
  if (Status checked = checkName(sample, request.output); !checked)
    return std::unexpected(checked.error());
  UnpublishedLogs logs(request.output);
  if (Status s = logs.made(); !s) return std::unexpected(s.error());
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
  if (Status s = logs.publish(request.output, *text); !s) return std::unexpected(s.error());
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
