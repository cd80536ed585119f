#include <chrono>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "proto/field_name.h"
#include "proto/limits.h"
#include "simplify/commands/commands.h"
#include "simplify/log/opened_log.h"
#include "simplify/mesh/workers.h"
#include "simplify/produce/added_steps.h"
#include "simplify/produce/edited_log_report.h"
#include "simplify/produce/follow_files.h"
#include "simplify/read/listed_files.h"
#include "simplify/remote/push_log.h"
#include "simplify/series/time_statistics.h"
#include "simplify/words/error_words.h"
#include "simplify/words/field_names.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/progress.h"
#include "simplify/words/read_words.h"

namespace qtet {
namespace {

// Seconds between two looks: files are not written more often, and nobody waits for longer.
constexpr double kMinInterval = 0.1, kMaxInterval = 3600;

/// A line a series: its new instants and their bytes.
void printSeries(const std::vector<const NewField*>& added, std::ostream& out) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> sums;
  for (const NewField* const field : added) {
    const ManifestField& info = field->info;
    auto& [instants, bytes] =
        sums[info.association + " field " + std::string(info.name.withoutTime())];
    ++instants;
    bytes += bytesOf(*field);
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
    if (const auto instant = field.info.name.instant())
      for (const std::string& name : statisticsNames(instant->series))
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

/// --times: one a file, of the words or of the series that one word names. Throws UsageError.
void takeTimes(std::vector<double> times, StepsRequest& out) {
  if (out.files.size() == 1 && namesFiles(out.files.front())) {
    out.reading.listed.times = std::move(times);
    return;
  }
  if (!times.empty() && times.size() != out.files.size())
    throw UsageError("--times gives " + std::to_string(times.size()) + " times for " +
                     std::to_string(out.files.size()) + " files; give one a file");
  out.times = std::move(times);
}

StepsRequest requestOf(const ParsedWords& parsed, Progress& progress) {
  StepsRequest out;
  out.files = parsed.get<std::vector<std::string>>("FILE...");
  out.reading = readOptionsOf(parsed);
  takeTimes(timesOf(parsed), out);
  out.reading.fields = parseFieldNames(parsed.get<std::string>("fields"));
  out.adding.fieldBits = parsed.integer("field-bits", kMinFieldBits, kMaxFieldBits);
  out.adding.errors = valueBoundsOf(parsed);
  out.adding.threads = threadsAtOnce(parsed.integer("threads", 1, kMaxAddingThreads));
  out.adding.progress = [&](double fraction) { progress.update(fraction); };
  return out;
}

/// A log that has all steps already, where -o names another: it is written there as it is.
Status reportNothing(const ParsedWords& parsed, const OpenedLog& log, const AddedSteps& none,
                     const OrderedJson& source, Progress& progress, Console& console) {
  AddedFields same = none.added;
  same.kept.resize(log.manifest.fields.size());
  std::iota(same.kept.begin(), same.kept.end(), 0U);
  if (parsed.has("output"))
    return writeAdded(parsed, log.file, same, source, printSeries, progress, console);
  progress.clear();
  for (const std::string& note : same.notes) console.note(note);
  const auto name = parsed.get<std::string>("LOG");
  if (!parsed.has("json")) {
    console.out << printable(name) << ": nothing to add\n";
    return {};
  }
  OrderedJson report{{"input", name}, {"output", name}, {"digest", log.file.digest()}};
  report.update(source);
  report["added"] = OrderedJson::array();
  report["notes"] = same.notes;
  report["warnings"] = OrderedJson::array();
  printJson(report, console);
  return {};
}

struct Pass {
  std::size_t steps = 0;         ///< that were added
  std::optional<Error> stopped;  ///< behind these a step cannot be read
};

/// Adds what the files have and the log does not. Reports that there is nothing only where
/// `reportsNone`.
Result<Pass> addSteps(const ParsedWords& parsed, const StepsRequest& request, bool reportsNone,
                      Progress& progress, Console& console) {
  const auto name = parsed.get<std::string>("LOG");
  const Result<OpenedLog> log = openLog(name);
  if (!log) return std::unexpected(log.error());
  progress.stage("decoding " + name);
  const Result<AddedSteps> steps = addedSteps(*log, request, progress);
  if (!steps) return std::unexpected(steps.error());
  const Pass out{steps->steps, steps->stopped};
  const OrderedJson source{{"files", request.files}, {"skipped", steps->skipped}};
  if (steps->steps == 0 && !reportsNone) return out;
  Status written =
      steps->steps == 0
          ? reportNothing(parsed, *log, *steps, source, progress, console)
          : writeAdded(parsed, log->file, steps->added, source, printSeries, progress, console);
  if (!written) return std::unexpected(written.error());
  warnOfStatistics(log->manifest, steps->added.fields, console);
  return out;
}

/// Sends the log as it lies there.
Status push(const std::string& file, const PushTarget& target, bool asJson, Console& console) {
  const Result<LogFile> log = LogFile::open(file);
  if (!log) return std::unexpected(log.error());
  const Result<Pushed> pushed = pushLog(*log, target, console);
  if (!pushed) return std::unexpected(pushed.error());
  reportPushed(*log, *pushed, asJson, console);
  return {};
}

/// Adds steps as they come, and pushes the log when it has changed.
void follow(const ParsedWords& parsed, StepsRequest request,
            const std::optional<PushTarget>& target, Progress& progress, Console& console) {
  const auto file = parsed.get<std::string>("LOG");
  bool isPushed = !target.has_value();
  request.keepsEarlier = true;
  const auto pass = [&]() -> Result<bool> {
    const Result<Pass> done = addSteps(parsed, request, false, progress, console);
    progress.clear();
    if (!done) return std::unexpected(done.error());
    if (done->steps > 0 && target) isPushed = false;
    if (!isPushed)
      if (Status s = push(file, *target, parsed.has("json"), console); !s)
        return std::unexpected(s.error());
    isPushed = true;
    if (done->stopped) return std::unexpected(*done->stopped);
    return done->steps > 0;
  };
  const auto seconds = parsed.number("every", kMinInterval, kMaxInterval);
  followFiles(request.files, std::chrono::milliseconds(static_cast<std::int64_t>(1000 * seconds)),
              pass, console);
}

Status addOrFollow(const ParsedWords& parsed, Progress& progress, Console& console) {
  const StepsRequest request = requestOf(parsed, progress);
  for (const std::string& file : request.files)
    if (Status checked = checkNewLog(parsed, file, console); !checked) return checked;
  const auto log = parsed.get<std::string>("LOG");
  const auto output = parsed.has("output") ? parsed.get<std::string>("output") : log;
  std::optional<PushTarget> target;
  if (parsed.has("push")) {
    if (output == "-") throw UsageError("--push sends a file; give -o a name");
    Result<PushTarget> read = pushTargetOf(parsed, parsed.get<std::string>("push"), output);
    if (!read) return std::unexpected(read.error());
    target = std::move(*read);
  }
  if (parsed.has("follow")) {
    if (parsed.has("output")) throw UsageError("--follow extends the log itself; leave -o out");
    if (const Result<OpenedLog> opened = openLog(log); !opened)
      return std::unexpected(opened.error());
    follow(parsed, request, target, progress, console);
    return {};
  }
  if (const auto done = addSteps(parsed, request, true, progress, console); !done)
    return std::unexpected(done.error());
  return target ? push(output, *target, parsed.has("json"), console) : Status{};
}

CommandHelp addStepsHelp() {
  return {"add-steps", "add-steps LOG.qtet FILE... [--times T,T] [-o OUT.qtet]",
          R"(Adds time steps of a simulation that goes on.
Each file holds one step or several, of the log's own mesh.
Steps of a time that the log has are left out, so the same command may be given again and again.
Steps are read in windows of eight, and coded as differences to each other and to the log's last
one. Where they make a window of eight full, that is coded once more as one.
All other blocks of the log stay as they are, byte for byte.
--json: input, output, digest, bytes, bytesBefore, tetrahedra, vertices, levels, fields (keys),
files, skipped, added [as of add-field], notes, warnings.)",
          R"(  qtet add-steps run.qtet run.pvd
  qtet add-steps run.qtet 'step_*.vtu'
  qtet add-steps run.qtet step-17.vtu step-18.vtu --times 1.7,1.8
  QTET_TOKEN=... qtet add-steps run.qtet run.pvd --follow --push http://127.0.0.1:8080/
)"};
}

}  // namespace

int runAddSteps(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()("times", po::value<std::string>(),
                        "one time a file, between commas, where the files know none: 0.1,0.2")(
      "fields", po::value<std::string>()->default_value("all"),
      "all: those of which the log has a series; or names as `qtet simplify --fields` takes them, "
      "for which all steps are read")(
      "output,o", po::value<std::string>(),
      "the log to write, NAME.qtet; or - for the standard output; without it the log itself is "
      "replaced once the new one is whole")(
      "field-bits", po::value<int>()->default_value(12),
      "bits of a float field's values that a series' own scale does not hold, 1 to 28")(
      "threads", po::value<int>()->default_value(1),
      "threads for measuring, as many as there are processors at most; the result does not depend "
      "on it")("follow",
               "waits for steps and adds each as soon as it is there, until Ctrl-C or SIGTERM")(
      "every", po::value<double>()->default_value(1),
      "seconds between two looks at the files with --follow, 0.1 to 3600")(
      "push", po::value<std::string>(),
      "sends the log to this URL, as qtet push does, whenever it has changed")(
      "json",
      "print one JSON object, and one of qtet push; with --follow whenever steps were added");
  addErrorOption(options);
  addPushOptions(options);
  addNoClobber(options);
  addReadOptions(options, "all");
  const ParsedWords parsed(words, addStepsHelp(), options, {"LOG", "FILE..."});
  if (parsed.helped(console)) return kExitOk;
  Progress progress(console);
  const Status done = addOrFollow(parsed, progress, console);
  progress.clear();
  return done ? kExitOk : reportFailure(done.error(), parsed.has("json"), console);
}

}  // namespace qtet
