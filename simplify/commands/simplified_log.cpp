#include "simplify/commands/simplified_log.h"

#include <chrono>
#include <iomanip>
#include <map>
#include <optional>
#include <span>
#include <sstream>

#include "codec/files/file_spool.h"
#include "simplify/commands/closing_report.h"
#include "simplify/commands/columns.h"
#include "simplify/commands/command_measure.h"
#include "simplify/commands/command_read.h"
#include "simplify/commands/error_table.h"
#include "simplify/commands/written_log.h"
#include "simplify/pipeline/series_pipeline.h"
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
const std::map<Stage, StageName> kStages{
    {Stage::kClean, {"clean", "cleaning"}},          {Stage::kQuantise, {"quantise", "quantising"}},
    {Stage::kSimplify, {"simplify", "simplifying"}}, {Stage::kMeasure, {"measure", "measuring"}},
    {Stage::kEncode, {"encode", "encoding"}},        {Stage::kKeep, {"keep", nullptr}}};

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

OrderedJson toJson(const Occurrences& found) {
  return {{"count", found.count}, {"first", found.first}};
}

OrderedJson toJson(const CleanReport& report) {
  OrderedJson edges = toJson(report.nonManifoldEdges);
  edges["firstOtherEnds"] = report.nonManifoldEdgeEnds;
  return {{"repeatedVertexCells", toJson(report.repeatedVertexCells)},
          {"duplicateCells", toJson(report.duplicateCells)},
          {"flatCells", toJson(report.flatCells)},
          {"reorientedCells", toJson(report.reorientedCells)},
          {"invertedCells", toJson(report.invertedCells)},
          {"unusedPoints", toJson(report.unusedPoints)},
          {"coincidentPoints", toJson(report.coincidentPoints)},
          {"nonManifoldEdges", edges},
          {"nonManifoldVertices", toJson(report.nonManifoldVertices)},
          {"components", report.components}};
}

/// Bytes and bits a tetrahedron of each stream.
void addSizes(const PipelineReport& made, std::uint64_t logBytes, OrderedJson& report) {
  const LogStatistics& statistics = made.statistics;
  const Manifest& manifest = made.manifest;
  const std::uint64_t tetrahedra = manifest.levels.back().tetrahedra;
  const auto bits = [&](std::uint64_t bytes) {
    return 8.0 * static_cast<double>(bytes) / static_cast<double>(tetrahedra);
  };
  OrderedJson fieldBytes = OrderedJson::object(), fieldBits = OrderedJson::object();
  for (std::size_t f = 0; f < manifest.fields.size(); ++f) {
    fieldBytes[fieldKey(manifest, f)] = statistics.fieldBytes[f];
    fieldBits[fieldKey(manifest, f)] = bits(statistics.fieldBytes[f]);
  }
  report["bytes"] = logBytes;
  report["bytesOf"] = {{"head", statistics.headBytes},
                       {"connectivity", statistics.structureBytes},
                       {"positions", statistics.positionBytes},
                       {"fields", fieldBytes}};
  report["bitsPerTetrahedron"] = {{"connectivity", bits(statistics.structureBytes)},
                                  {"positions", bits(statistics.positionBytes)},
                                  {"fields", fieldBits},
                                  {"total", bits(logBytes)}};
}

OrderedJson toJson(const PaperFigures& figures) {
  const PaperFigures::Refused& refused = figures.refused;
  const double average = figures.fusions > 0 ? static_cast<double>(figures.removed) /
                                                   static_cast<double>(figures.fusions)
                                             : 0;
  return {{"fusions", figures.fusions},
          {"interiorFusions", figures.interiorFusions},
          {"removed", figures.removed},
          {"averageRemoved", average},
          {"seconds", {{"initialise", figures.initialiseSeconds}, {"fuse", figures.fuseSeconds}}},
          {"refused",
           {{"flip", refused.flip},
            {"envelope", refused.envelope},
            {"topology", refused.topology},
            {"few", refused.few}}}};
}

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

/// The counts are those of the bytes written, not of what was meant to be written.
OrderedJson reportOf(const SimplifyRequest& request, const ReadReport& read,
                     const PipelineReport& from, const WrittenLog& written,
                     const Stopwatch& watch) {
  const Manifest& manifest = from.manifest;
  const std::uint64_t full = manifest.levels.back().tetrahedra,
                      base = manifest.levels.front().tetrahedra;
  const bool isPaper = request.pipeline.algorithm == Algorithm::kPaper;
  OrderedJson report = {
      {"input", request.input},
      {"output", request.output},
      {"algorithm", isPaper ? "paper" : "qtet"},
      {"digest", written.digest},
      {"tetrahedra", {{"input", from.tetrahedraIn}, {"full", full}, {"base", base}}},
      {"vertices", manifest.levels.back().vertices},
      {"percentRemoved", 100.0 * (1.0 - static_cast<double>(base) / static_cast<double>(full))},
      {"levels", manifest.levels.size() - 1},
      {"chunks", from.index.chunks.size()}};
  report["records"] = from.statistics.records;
  if (from.boundaryWeight) report["boundaryWeight"] = *from.boundaryWeight;
  for (const auto& [name, weight] : from.labelWeights) report["labelWeights"][name] = weight;
  addSizes(from, written.bytes, report);
  if (!from.index.closing.empty()) report["kept"] = closingJson(from.index.closing, manifest);
  report["error"] = measureReport(request.pipeline.measure, manifest);
  report["lattice"] = {{"bits", manifest.latticeBits},
                       {"requestedBits", from.quantise.requestedBits},
                       {"step", manifest.latticeStep},
                       {"origin", manifest.latticeOrigin},
                       {"worseCells", toJson(from.quantise.worseCells)}};
  report["clean"] = toJson(from.clean);
  report["mesh"] = soundnessReport(from.clean);
  report["read"] = readReport(read);
  report["ignoredCells"] = read.ignoredCells;
  report["ignoredFields"] = read.ignoredFields;
  report["nonFiniteValues"] = from.quantise.nonFiniteValues;
  report["seconds"] = watch.seconds();
  report["notes"] = withOptionNames(read.notes);
  for (const std::string& note : withOptionNames(from.notes)) report["notes"].push_back(note);
  report["warnings"] = withOptionNames(read.warnings);
  for (const std::string& warning : withOptionNames(from.warnings))
    report["warnings"].push_back(warning);
  if (from.paper) report["paper"] = toJson(*from.paper);
  return report;
}

struct Made {
  ReadReport read;
  PipelineOutput output;
};

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

/// A row a field: its bits a tetrahedron, and the base mesh's error where it was measured.
std::string fieldTable(const OrderedJson& fields, const OrderedJson& error) {
  const auto text = [](double number) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(2) << number;
    return out.str();
  };
  const bool isMeasured = error.contains("base");
  std::vector<std::vector<std::string>> rows{{"field", "bits a tetrahedron"}};
  if (isMeasured) rows[0].emplace_back("the base mesh");
  std::size_t f = 0;
  for (const auto& [name, bits] : fields.items()) {
    if (rows.size() > kShownFields) break;
    rows.push_back({printable(name), text(bits.get<double>())});
    if (isMeasured) rows.back().push_back(fieldErrorText(error["base"]["fields"][f++]));
  }
  return columns(rows) + moreFields(fields.size(), "'qtet info --all' shows them");
}

/// Beside which file blocks wait until the log is written.
std::filesystem::path spoolOf(const Output& output) {
  return output.stream == nullptr ? output.file
                                  : std::filesystem::temp_directory_path() / "standard-output.qtet";
}

}  // namespace

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
  const Result<Made> all = isLong ? makeInWindows(request, times, options, watch)
                                  : makeAtOnce(request, times, options, watch);
  if (!all) return std::unexpected(all.error());
  const PipelineOutput* const made = &all->output;
  watch.lap(made->report);
  const Result<WrittenLog> written =
      writeLog(output, [&](const ByteSink& sink) { return made->log.writeTo(sink); });
  if (!written) return std::unexpected(written.error());
  watch.lap("write");
  return reportOf(request, all->read, made->report, *written, watch);
}

void printMadeLog(const OrderedJson& report, std::ostream& out) {
  const OrderedJson& bits = report["bitsPerTetrahedron"];
  const std::size_t fields = bits["fields"].size();
  out << std::fixed << std::setprecision(1) << printable(report["output"].get<std::string>())
      << ": " << counted(report["tetrahedra"]["full"], "tetrahedron", "tetrahedra")
      << ", of which the base mesh keeps " << grouped(report["tetrahedra"]["base"]) << " ("
      << report["percentRemoved"].get<double>() << " % removed), refined in "
      << counted(report["levels"], "level", "levels") << "\n"
      << grouped(report["bytes"]) << " bytes, " << std::setprecision(2)
      << bits["total"].get<double>() << " bits a tetrahedron: connectivity "
      << bits["connectivity"].get<double>() << ", positions " << bits["positions"].get<double>();
  if (fields == 1)
    out << ", " << printable(bits["fields"].begin().key()) << " "
        << bits["fields"].begin()->get<double>();
  out << "\n";
  out << soundnessText(report["mesh"]) << "\n";
  const OrderedJson& error = report["error"];
  if (const std::string measured = measureSentence(error); !measured.empty()) {
    out << measured;
    if (fields == 1)
      out << ", " << printable(bits["fields"].begin().key()) << " "
          << fieldErrorText(error["base"]["fields"][0]);
    out << "\n";
  }
  if (fields > 1) out << fieldTable(bits["fields"], error);
  out << "lattice of " << report["lattice"]["bits"] << " bits an axis, step "
      << report["lattice"]["step"] << "; ";
  if (report.contains("boundaryWeight"))
    out << "boundary weight " << report["boundaryWeight"].get<double>() << "; ";
  if (report.contains("labelWeights"))
    for (const auto& [name, weight] : report["labelWeights"].items())
      out << "weight of the label " << printable(name) << " " << weight.get<double>() << "; ";
  out << std::setprecision(1) << report["seconds"]["total"].get<double>() << " s\n";
}

}  // namespace qtet
