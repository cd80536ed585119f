#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "proto/field_key.h"
#include "proto/limits.h"
#include "proto/number_text.h"
#include "proto/series.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/commands/command_line.h"
#include "simplify/commands/command_read.h"
#include "simplify/commands/edited_log_report.h"
#include "simplify/commands/progress.h"
#include "simplify/log/add_fields.h"
#include "simplify/log/opened_log.h"
#include "simplify/mesh/workers.h"
#include "simplify/read/options/time_steps.h"
#include "simplify/read/read_mesh.h"
#include "simplify/series/series.h"
#include "simplify/series/time_statistics.h"

namespace qtet {
namespace {

/// --times: one number a file. Throws UsageError.
std::vector<double> timesOf(const ParsedWords& parsed, std::size_t files) {
  std::vector<double> out;
  if (!parsed.has("times")) return out;
  const auto text = parsed.get<std::string>("times");
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    double time = 0;
    const auto [stop, code] = std::from_chars(text.data() + at, text.data() + end, time);
    if (code != std::errc() || stop != text.data() + end || !std::isfinite(time))
      throw UsageError("--times '" + text + "' is no list of numbers between commas");
    out.push_back(time);
    at = end + 1;
  }
  if (out.size() != files)
    throw UsageError("--times gives " + std::to_string(out.size()) + " times for " +
                     std::to_string(files) + " files; give one a file");
  return out;
}

/// The end of a series: its last time, and what its instants have in common.
struct SeriesEnd {
  double time = 0;
  std::uint32_t components = 1;
  std::string type;
};
/// By association and name.
using SeriesEnds = std::map<std::pair<std::string, std::string>, SeriesEnd>;

SeriesEnds seriesEndsOf(const Manifest& manifest) {
  SeriesEnds out;
  for (const ManifestField& field : manifest.fields) {
    const auto name = instantName(field.name);
    if (!name) continue;
    const auto at = out.try_emplace({field.association, std::string(name->series)},
                                    SeriesEnd{name->time, field.components, field.type});
    at.first->second.time = std::max(at.first->second.time, name->time);
  }
  return out;
}

/// Gives fields without a time that of their file. Errors: bad-input (neither knows a time, or both
/// do).
Status nameInstants(TetMesh& mesh, const std::string& file, std::optional<double> time) {
  for (MeshField& field : mesh.fields) {
    const bool isNamed = instantName(field.name).has_value();
    if (isNamed && time)
      return fail(ErrorCode::kBadInput,
                  file + " has times of its own (" + field.name + "); leave --times out");
    if (!isNamed && !time)
      return fail(ErrorCode::kBadInput, file + " knows no time; give it with --times");
    if (!isNamed) field.name += "@" + shortestText(*time);
  }
  return {};
}

/// Puts an instant behind the end of its series. Errors: bad-input (another type or number of
/// components), bad-value (an instant that is not behind the last one).
Status append(MeshField& field, const std::string& file, SeriesEnds& ends) {
  const auto name = instantName(field.name);
  const auto at = ends.try_emplace({field.association, std::string(name->series)},
                                   SeriesEnd{name->time, field.components, field.type});
  SeriesEnd& end = at.first->second;
  if (at.second) return {};
  const bool areFloats = isFloatType(field.type) && isFloatType(end.type);
  if (field.components != end.components || (field.type != end.type && !areFloats))
    return fail(ErrorCode::kBadInput, file + ": " + field.name + " has " +
                                          std::to_string(field.components) + " components of " +
                                          field.type + ", its series in the log " +
                                          std::to_string(end.components) + " of " + end.type +
                                          "; write it as the earlier steps are");
  if (name->time <= end.time || isSameTime(name->time, end.time))
    return fail(ErrorCode::kBadValue,
                file + ": " + field.name + " is not behind the last instant, " +
                    shortestText(end.time) + "; give steps in the order of their times");
  if (field.type != end.type && end.type == "float32")
    for (double& value : field.values) value = static_cast<float>(value);
  field.type = end.type;
  end.time = name->time;
  return {};
}

/// Leaves the fields of which the log has a series; all where they were `asked` for. Errors:
/// not-found (none is left), append's.
Status keepInstants(TetMesh& mesh, const std::string& file, bool asked, SeriesEnds& ends,
                    std::vector<std::string>& notes) {
  std::string left;
  std::erase_if(mesh.fields, [&](const MeshField& field) {
    const auto name = instantName(field.name);
    const bool stays = asked || ends.contains({field.association, std::string(name->series)});
    if (!stays) left += (left.empty() ? "" : ", ") + field.name;
    return !stays;
  });
  if (mesh.fields.empty())
    return fail(ErrorCode::kNotFound, file + " holds no instant of a series of the log" +
                                          (left.empty() ? "" : " (it has " + left + ")") +
                                          "; name others with --fields");
  if (!left.empty())
    notes.push_back(file + ": left out, since the log has no such series: " + left +
                    "; --fields adds them");
  std::ranges::sort(mesh.fields, {}, [](const MeshField& field) {
    return std::tuple(instantName(field.name)->time, field.association, field.name);
  });
  for (MeshField& field : mesh.fields)
    if (Status s = append(field, file, ends); !s) return s;
  return {};
}

/// Adds files in windows, so that the values of no more than one window are in memory at once.
class Windows {
 public:
  explicit Windows(FieldAdder& adder) : adder_(adder) {}

  Status take(TetMesh&& mesh) {
    const bool isSame = mesh.points == pending_.points && mesh.tetrahedra == pending_.tetrahedra;
    if (!isSame)
      if (Status s = flush(); !s) return s;
    if (pending_.fields.empty()) {
      pending_ = std::move(mesh);
    } else {
      std::ranges::move(mesh.fields, std::back_inserter(pending_.fields));
    }
    return ++steps_ < kWindow ? Status{} : flush();
  }
  Status flush() {
    steps_ = 0;
    if (pending_.fields.empty()) return {};
    const Status added = adder_.add(pending_);
    pending_.fields.clear();
    return added;
  }

 private:
  FieldAdder& adder_;
  TetMesh pending_;
  std::size_t steps_ = 0;
};

struct Request {
  std::vector<std::string> files;
  std::vector<double> times;
  ReadOptions reading;
  AddFieldsOptions adding;
};

Result<AddedFields> addFiles(const OpenedLog& log, const Request& request, Progress& progress) {
  Result<FieldAdder> adder = FieldAdder::make(log.file, request.adding);
  if (!adder) return std::unexpected(adder.error());
  SeriesEnds ends = seriesEndsOf(log.manifest);
  std::vector<std::string> notes;
  Windows windows(*adder);
  for (std::size_t i = 0; i < request.files.size(); ++i) {
    const std::string& file = request.files[i];
    progress.stage("adding " + file);
    Result<ReadMesh> read = readMesh(file, request.reading);
    if (!read) return std::unexpected(read.error());
    const auto time = request.times.empty() ? std::nullopt : std::optional(request.times[i]);
    if (Status s = nameInstants(read->mesh, file, time); !s) return std::unexpected(s.error());
    if (Status s = keepInstants(read->mesh, file, request.reading.fields.has_value(), ends, notes);
        !s)
      return std::unexpected(s.error());
    if (const auto cleaned = cleanMesh(read->mesh); !cleaned)
      return std::unexpected(cleaned.error());
    if (Status s = windows.take(std::move(read->mesh)); !s) return std::unexpected(s.error());
  }
  if (Status s = windows.flush(); !s) return std::unexpected(s.error());
  AddedFields out = adder->take();
  out.notes.insert(out.notes.begin(), notes.begin(), notes.end());
  return out;
}

/// A line a series: its new instants and their bytes.
void printSeries(const std::vector<NewField>& added, std::ostream& out) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> sums;
  for (const NewField& field : added) {
    auto& [instants, bytes] =
        sums[field.info.association + " field " +
             std::string(nameWithoutStep(field.info.name).value_or(field.info.name))];
    ++instants;
    bytes += bytesOf(field);
  }
  for (const auto& [name, sum] : sums)
    out << printable(name) << ": " << sum.first << (sum.first == 1 ? " instant, " : " instants, ")
        << sum.second << " bytes\n";
}

/// Names the log's statistics of series that have more instants now.
void warnOfStatistics(const Manifest& manifest, const std::vector<NewField>& added,
                      Console& console) {
  std::set<std::pair<std::string, std::string>> statistics;  // association, name
  for (const NewField& field : added)
    if (const auto series = nameWithoutStep(field.info.name))
      for (const std::string& name : statisticsNames(*series))
        statistics.emplace(field.info.association, name);
  std::string names;
  for (const ManifestField& field : manifest.fields)
    if (statistics.contains({field.association, field.name}))
      names += (names.empty() ? "" : ", ") + field.name;
  if (names.empty()) return;
  console.warn(names +
               " do not count the added instants; make the log again with 'qtet simplify "
               "--time-statistics', or remove them with 'qtet remove-field'");
}

Status addSteps(const ParsedWords& parsed, Progress& progress, Console& console) {
  Request request;
  request.files = parsed.get<std::vector<std::string>>("FILE...");
  request.times = timesOf(parsed, request.files.size());
  request.reading = readOptionsOf(parsed);
  request.reading.fields = parseFieldNames(parsed.get<std::string>("fields"));
  request.reading.namesTime = true;
  request.adding.fieldBits = parsed.integer("field-bits", kMinFieldBits, kMaxFieldBits);
  request.adding.threads = threadsAtOnce(parsed.integer("threads", 1, kMaxAddingThreads));
  request.adding.progress = [&](double fraction) { progress.update(fraction); };
  for (const std::string& file : request.files)
    if (Status checked = checkNewLog(parsed, file, console); !checked) return checked;
  const Result<OpenedLog> log = openLog(parsed.get<std::string>("LOG"));
  if (!log) return std::unexpected(log.error());
  progress.stage("decoding " + parsed.get<std::string>("LOG"));
  const Result<AddedFields> added = addFiles(*log, request, progress);
  if (!added) return std::unexpected(added.error());
  std::vector<std::uint32_t> kept(log->manifest.fields.size());
  std::iota(kept.begin(), kept.end(), 0u);
  Status written = writeAdded(parsed, log->file, kept, *added, {{"files", request.files}},
                              printSeries, progress, console);
  if (written) warnOfStatistics(log->manifest, added->fields, console);
  return written;
}

}  // namespace

int runAddSteps(const Words& words, Console& console) {
  namespace po = boost::program_options;
  po::options_description options("options");
  options.add_options()("times", po::value<std::string>(),
                        "one time a file, between commas, where the files know none: 0.1,0.2")(
      "fields", po::value<std::string>()->default_value("all"),
      "all: those of which the log has a series; or names as `qtet simplify --fields` takes them")(
      "output,o", po::value<std::string>(),
      "the log to write, NAME.qtet; or - for the standard output; without it the log itself is "
      "replaced once the new one is whole")(
      "field-bits", po::value<int>()->default_value(12),
      "bits of a float field's values that a series' own scale does not hold, 1 to 28")(
      "threads", po::value<int>()->default_value(1),
      "threads for measuring, as many as there are processors at most; the result does not depend "
      "on it")("json", "print one JSON object");
  addNoClobber(options);
  addReadOptions(options, "all");
  const ParsedWords parsed(
      words,
      {"add-steps", "add-steps LOG.qtet FILE... [--times T,T] [-o OUT.qtet]",
       "Adds time steps of a simulation that goes on behind those that the log has. Each file "
       "holds "
       "one step or several, of the log's own mesh.\n"
       "Steps are read in windows of eight, and coded as differences to each other and to the "
       "log's "
       "last one. All blocks of the log stay as they\nare, byte for byte.\n"
       "--json: input, output, digest, bytes, bytesBefore, tetrahedra, vertices, levels, fields "
       "(keys), files, added [as of add-field], notes.",
       "  qtet add-steps run.qtet later.pvd\n  qtet add-steps run.qtet step-17.vtu step-18.vtu "
       "--times 1.7,1.8\n"},
      options, {"LOG", "FILE..."});
  if (parsed.helped(console)) return kExitOk;
  Progress progress(console);
  const Status done = addSteps(parsed, progress, console);
  progress.clear();
  return done ? kExitOk : reportFailure(done.error(), parsed.has("json"), console);
}

}  // namespace qtet
