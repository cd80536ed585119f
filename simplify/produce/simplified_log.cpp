#include "simplify/produce/simplified_log.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "codec/files/file_spool.h"
#include "simplify/pipeline/series_pipeline.h"
#include "simplify/produce/made_log_report.h"
#include "simplify/produce/written_log.h"
#include "simplify/read/pieces/vtu_pieces.h"
#include "simplify/read/read_mesh.h"
#include "simplify/read/read_times.h"
#include "simplify/series/series.h"

namespace qtet {
namespace {

/// A stage's name in JSON, and its description for people who wait; kKeep continues what kEncode
/// began.
struct StageName {
  const char* name;
  const char* doing;
};
const std::map<Stage, StageName> kStages{{Stage::kClean, {"clean", "cleaning"}},
                                         {Stage::kQuantise, {"quantise", "quantising"}},
                                         {Stage::kReduce, {"reduce", "reducing"}},
                                         {Stage::kSimplify, {"simplify", "simplifying"}},
                                         {Stage::kMeasure, {"measure", "measuring"}},
                                         {Stage::kEncode, {"encode", "encoding"}},
                                         {Stage::kKeep, {"keep", nullptr}}};

/// Wall time of each stage, by name, in the order of doing.
class Stopwatch {
 public:
  void lap(const std::string& name) {
    const Clock::time_point now = Clock::now();
    seconds_[name] = std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  /// The stages of a pipeline that has just ended.
  void lap(const PipelineReport& report) {
    for (const auto& [stage, seconds] : report.seconds) {
      OrderedJson& sum = seconds_[kStages.at(stage).name];
      sum = seconds + (sum.is_null() ? 0 : sum.get<double>());
    }
    last_ = Clock::now();
  }
  [[nodiscard]] OrderedJson seconds() const {
    OrderedJson out = seconds_;
    out["total"] = std::chrono::duration<double>(last_ - start_).count();
    return out;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now(), last_ = start_;
  OrderedJson seconds_ = OrderedJson::object();
};

/// A pipeline's progress, for the person who waits.
auto shownBy(Progress& progress) {
  return [&progress, shown = std::optional<Stage>()](Stage stage, double fraction) mutable {
    const char* doing = kStages.at(stage).doing;
    if (doing == nullptr) return;
    if (stage == shown) return progress.update(fraction);
    progress.stage(doing);
    shown = stage;
  };
}

struct Made {
  ReadReport read;
  PipelineOutput output;
};

/// Bytes that are free, as the system tells; most where it does not.
std::uint64_t freeMemory() {
  std::ifstream info("/proc/meminfo");
  std::string name, unit;
  for (std::uint64_t kilobytes = 0; info >> name >> kilobytes;) {
    if (name == "MemAvailable:") return kilobytes * 1024;
    std::getline(info, unit);
  }
  return std::numeric_limits<std::uint64_t>::max();
}

/// Cells of a file that is to be reduced piece by piece; null: it is read as a whole.
Result<std::unique_ptr<VtuPieces>> piecesOf(const SimplifyRequest& request,
                                            PipelineOptions& options, std::string& note) {
  if (options.keep.any() || options.timeStatistics || options.algorithm == Algorithm::kPaper)
    return nullptr;
  std::string why;
  Result<std::unique_ptr<VtuPieces>> pieces = VtuPieces::open(request.input, request.read, why);
  const bool isAsked = options.finest.has_value();
  if (!pieces) return isAsked ? std::move(pieces) : nullptr;  // reading says what is wrong
  if (!*pieces) {
    if (options.memory) note = "the file was read as a whole: " + why;
    return nullptr;
  }
  const std::uint64_t cells = (*pieces)->cells();
  if (isAsked) return cells > *options.finest ? std::move(pieces) : nullptr;
  const std::uint64_t free = freeMemory();
  if (cells <= kDefaultFinest || cells <= free / kLeastBytesACell) return nullptr;
  options.finest = kDefaultFinest;
  note = "simplifying its " + std::to_string(cells) + " cells takes " +
         std::to_string(cells * kLeastBytesACell / 1'000'000'000) + " GB and more, and " +
         std::to_string(free / 1'000'000'000) + " GB are free: the log ends at " +
         std::to_string(kDefaultFinest) + " cells; `finest` or `memory` sets another end";
  return pieces;
}

Result<Made> makeInPieces(VtuPieces& pieces, const PipelineOptions& options) {
  if (Status s = pieces.begin(options.spool); !s) return std::unexpected(s.error());
  Result<PipelineOutput> made = simplifyToLog(pieces, options);
  if (!made) return std::unexpected(made.error());
  return Made{pieces.report(), std::move(*made)};
}

Result<Made> makeAtOnce(const SimplifyRequest& request, const std::vector<double>& times,
                        const PipelineOptions& options, Stopwatch& watch) {
  Result<ReadMesh> read = times.size() > kWindow
                              ? readTimesInParts(request.input, request.read, times, kWindow)
                              : readMesh(request.input, request.read);
  if (!read) return std::unexpected(read.error());
  watch.lap("read");
  Result<PipelineOutput> made = simplifyToLog(std::move(read->mesh), options);
  if (!made) return std::unexpected(made.error());
  return Made{std::move(read->report), std::move(*made)};
}

Result<Made> makeInWindows(const SimplifyRequest& request, const std::vector<double>& times,
                           const PipelineOptions& options, Stopwatch& watch) {
  ReadReport report;
  ReadOptions reading = request.read;
  const auto read = [&](std::span<const std::size_t> steps) -> Result<TetMesh> {
    std::vector<double> some;
    for (const std::size_t step : steps) some.push_back(times[step]);
    Result<TetMesh> window = readWindow(request.input, reading, some, times.front(), report);
    if (window && request.read.weld && !report.motion.empty())
      return fail(ErrorCode::kBadValue,
                  request.input +
                      ": its points move, and so many steps cannot be welded: which "
                      "points stay together is known of a few steps at a time; leave "
                      "out `weld`, or choose fewer steps with `time`");
    return window;
  };
  Result<TetMesh> sample = read(sampledSteps(times.size()));
  if (!sample) return std::unexpected(sample.error());
  reading.moves = !report.motion.empty();
  watch.lap("read");
  Result<PipelineOutput> made = simplifySeries(std::move(*sample), times.size(), read, options);
  if (!made) return std::unexpected(made.error());
  return Made{std::move(report), std::move(*made)};
}

/// Beside which file blocks wait until the log is written.
std::filesystem::path spoolOf(const Output& output) {
  return output.stream == nullptr ? output.file
                                  : std::filesystem::temp_directory_path() / "standard-output.qtet";
}

}  // namespace

std::size_t finestWithin(std::uint64_t memory) {
  return std::min<std::size_t>(kDefaultFinest, memory / kMostBytesACell);
}

Result<OrderedJson> makeLog(const SimplifyRequest& request, const Output& output,
                            Progress& progress) {
  Stopwatch watch;
  progress.stage("reading " + request.input);
  PipelineOptions options = request.pipeline;
  options.progress = shownBy(progress);
  options.spool = [&] { return fileSpoolBeside(spoolOf(output)); };
  const Result<ChosenTimes> chosen = chosenTimesOf(request.input, request.read);
  if (!chosen) return std::unexpected(chosen.error());
  const std::vector<double>& times = chosen->times;
  const bool isLong = times.size() > kSampledInstants && !request.pipeline.keep.exact &&
                      times.size() * chosen->valuesOfAStep > kMaxValuesAtOnce;
  std::string note;
  const Result<std::unique_ptr<VtuPieces>> pieces =
      times.size() > 1 ? nullptr : piecesOf(request, options, note);
  if (!pieces) return std::unexpected(pieces.error());
  Result<Made> all = *pieces  ? makeInPieces(**pieces, options)
                     : isLong ? makeInWindows(request, times, options, watch)
                              : makeAtOnce(request, times, options, watch);
  if (!all) return std::unexpected(all.error());
  if (!note.empty()) all->read.notes.insert(all->read.notes.begin(), std::move(note));
  const PipelineOutput* const made = &all->output;
  watch.lap(made->report);
  const Result<WrittenLog> written =
      writeLog(output, [&](const ByteSink& sink) { return made->log.writeTo(sink); });
  if (!written) return std::unexpected(written.error());
  watch.lap("write");
  return madeLogReport(request, all->read, made->report, *written, watch.seconds());
}

}  // namespace qtet
