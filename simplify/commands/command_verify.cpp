#include <iomanip>
#include <numeric>
#include <sstream>

#include "codec/refine/verify_log.h"
#include "proto/checksum.h"
#include "proto/number_text.h"
#include "proto/rounding_error.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/clean/verify.h"
#include "simplify/commands/closing_report.h"
#include "simplify/commands/command_line.h"
#include "simplify/commands/command_read.h"
#include "simplify/commands/progress.h"
#include "simplify/commands/several_logs.h"
#include "simplify/log/kept_input.h"
#include "simplify/log/opened_list.h"
#include "simplify/log/opened_log.h"
#include "simplify/read/read_mesh.h"

namespace qtet {
namespace {

struct Input {
  std::string path;
  ReadOptions options;
};

/// The input read as its options say, cleaned and put on the log's lattice, against what was
/// decoded; what was found in `out`.
Status compareWithInput(const OpenedLog& log, const Refiner& refiner, const Input& input,
                        Progress& progress, OrderedJson& out) {
  progress.stage("reading " + input.path);
  std::vector<std::uint32_t> all(log.manifest.fields.size());
  std::iota(all.begin(), all.end(), 0u);
  const LatticeMesh decoded = latticeMesh(log.manifest, refiner, all);
  std::vector<std::string> names;
  for (const FieldInfo& field : decoded.fields)
    names.push_back(field.association + ":" + field.name);
  ReadOptions options = input.options;
  options.fields = names;
  options.originalIds = log.file.hasClosing(ClosingKind::kOriginalCells);
  Result<ReadMesh> read = readMesh(input.path, options);
  if (!read) return std::unexpected(read.error());
  const std::vector<Tetrahedron> asStored = read->mesh.tetrahedra;
  const Result<CleanReport> cleaned = cleanMesh(read->mesh);
  if (!cleaned) return std::unexpected(cleaned.error());
  const auto cells = options.originalIds ? takeOriginalCells(read->mesh) : std::nullopt;

  progress.stage("comparing");
  const Result<OnLattice> expected = putOnLattice(read->mesh, decoded.lattice, decoded.fields);
  if (!expected) return std::unexpected(expected.error());
  const Result<VerifyReport> same = sameMesh(decoded, expected->mesh);
  if (!same) return std::unexpected(same.error());
  const Result<OrderedJson> kept =
      compareKept(log.file, decoded, expected->mesh, asRead(read->mesh, asStored, *cleaned), cells);
  if (!kept) return std::unexpected(kept.error());
  OrderedJson fieldErrors = OrderedJson::object(), valueErrors = OrderedJson::object();
  for (std::size_t f = 0; f < names.size(); ++f) {
    fieldErrors[fieldKey(log.manifest, f)] = expected->largestFieldErrors[f];
    OrderedJson& values = valueErrors[fieldKey(log.manifest, f)];
    values = {{"largest", expected->largestValueErrors[f]},
              {"bound", largestRoundingError(log.manifest.fields[f])}};
    if (const auto unit = unitOf(log.manifest, log.manifest.fields[f].name); !unit.empty())
      values["unit"] = unit;
  }
  out = {{"input", input.path},
         {"sameMesh", true},
         {"largestPositionErrorSteps", expected->largestPositionError},
         {"largestFieldErrorSteps", fieldErrors},
         {"valueErrors", valueErrors},
         {"interchangeableVertices", same->interchangeable},
         {"droppedPoints", cleaned->unusedPoints.count},
         {"droppedCells", cleaned->repeatedVertexCells.count + cleaned->duplicateCells.count},
         {"kept", *kept}};
  return {};
}

std::optional<Input> inputOf(const ParsedWords& parsed) {
  if (!parsed.has("against")) return std::nullopt;
  return Input{parsed.get<std::string>("against"), readOptionsOf(parsed)};
}

Result<OrderedJson> verify(const OpenedLog& log, const std::optional<Input>& input,
                           Progress& progress) {
  progress.stage("decoding");
  const Result<Refiner> refiner = decodeVerified(
      log.file, log.manifest, [&](double fraction) { return progress.update(fraction), true; },
      input ? Verified::kFields : Verified::kMesh);
  if (!refiner) return std::unexpected(refiner.error());
  const ManifestLevel& finest = log.manifest.levels.back();
  OrderedJson report = {{"ok", true},
                        {"digest", log.file.digest()},
                        {"meshDigest", toHex(refiner->digest())},
                        {"bytes", log.file.bytes().size()},
                        {"chunks", log.file.chunks().size()},
                        {"levels", log.manifest.levels.size()},
                        {"tetrahedra", finest.tetrahedra},
                        {"vertices", finest.vertices},
                        {"boundaryTriangles", finest.boundaryTriangles}};
  if (!input) return report;
  OrderedJson against;
  if (Status s = compareWithInput(log, *refiner, *input, progress, against); !s)
    return std::unexpected(s.error());
  report["against"] = against;
  return report;
}

/// The times of the input's steps; none where it knows none, or cannot be read.
std::vector<double> timesOfInput(const Input& input) {
  ReadOptions options = input.options;
  options.time = "first";
  options.fields = std::vector<std::string>{};
  options.threshold.reset();
  const Result<ReadMesh> read = readMesh(input.path, options);
  return read ? read->report.times : std::vector<double>{};
}

/// Without --time an input of several steps is read at the instants that the log has.
void takeInstants(const Manifest& manifest, Progress& progress, Input& input) {
  if (input.options.time != ReadOptions().time) return;
  const std::vector<double> instants = instantTimes(manifest);
  if (instants.empty()) return;
  progress.stage("reading the times of " + input.path);
  if (timesOfInput(input).empty()) return;
  input.options.time = timesText(instants);
  input.options.namesTime = true;
}

Result<OrderedJson> verifyLog(const std::string& path, std::optional<Input> input,
                              Progress& progress) {
  progress.stage("checking checksums");
  const Result<OpenedLog> log = openLog(path);
  if (!log) return std::unexpected(log.error());
  if (input) takeInstants(log->manifest, progress, *input);
  return verify(*log, input, progress);
}

/// Each log of a list; against the steps of the input at the segment's times.
Result<OrderedJson> verifyList(const std::string& path, std::optional<Input> input,
                               Progress& progress) {
  const Result<SegmentList> list = openList(path);
  if (!list) return std::unexpected(list.error());
  OrderedJson report = {{"ok", true}, {"segments", OrderedJson::array()}};
  for (const Segment& segment : list->segments) {
    if (input) input->options.time = timesText(segment.times), input->options.namesTime = true;
    progress.stage("checking checksums of " + segment.log);
    const Result<OpenedLog> log = openSegment(path, segment);
    if (!log) return std::unexpected(log.error());
    Result<OrderedJson> one = verify(*log, input, progress);
    if (!one) {
      one.error().message = path + ", " + segment.log + ": " + one.error().message;
      return one;
    }
    report["segments"].push_back(
        {{"log", segment.log}, {"times", segment.times}, {"verified", std::move(*one)}});
  }
  return report;
}

/// Dropped points and cells shift the numbers of those behind them (kept_input.h, asRead).
std::string orderSentence(const OrderedJson& against) {
  const auto points = against["droppedPoints"].get<std::uint64_t>(),
             cells = against["droppedCells"].get<std::uint64_t>();
  if (points + cells == 0)
    return "its points, cells and their vertices are numbered as in the file\n";
  return "its points and cells are numbered in the file's order, but count without " +
         counted(points, "point", "points") + " and " + counted(cells, "cell", "cells") +
         " of the file that were dropped; a cell that was turned stays turned\n";
}

/// "each value of T is within 0.5 K of the input's; the largest difference is 0.499 K"
void printValueError(const std::string& name, const OrderedJson& error, std::ostream& out) {
  const std::string unit = printable(error.value("unit", ""));
  const auto measure = [&](const char* which) {
    return roundedText(error[which].get<double>()) + (unit.empty() ? "" : " " + unit);
  };
  out << "each value of " << printable(name);
  if (error["bound"] == 0)
    out << " is the input's\n";
  else
    out << " is within " << measure("bound") << " of the input's; the largest difference is "
        << measure("largest") << "\n";
}

void printReport(const OrderedJson& report, std::ostream& out) {
  out << "digest      " << report["digest"].get<std::string>() << "\nmeshDigest  "
      << report["meshDigest"].get<std::string>()
      << "\nevery checksum and count is right: " << grouped(report["bytes"]) << " bytes, "
      << counted(report["chunks"], "chunk", "chunks") << ", "
      << counted(report["levels"].get<std::size_t>() - 1, "level", "levels")
      << " above the base mesh, " << counted(report["tetrahedra"], "tetrahedron", "tetrahedra")
      << ", " << counted(report["vertices"], "vertex", "vertices") << "\n";
  if (!report.contains("against")) return;
  const OrderedJson& against = report["against"];
  out << std::setprecision(3) << "the finest level is the mesh of "
      << printable(against["input"].get<std::string>()) << ", cell for cell; positions are within "
      << against["largestPositionErrorSteps"].get<double>() << " lattice steps";
  for (const auto& [name, error] : against["largestFieldErrorSteps"].items())
    out << ", " << printable(name) << " within " << error.get<double>() << " field steps";
  out << "\n";
  for (const auto& [name, error] : against["valueErrors"].items())
    printValueError(name, error, out);
  if (against["kept"]["order"].get<bool>()) out << orderSentence(against);
  if (against["kept"].value("originalCells", false))
    out << "its cells know which cell of the file they come from\n";
  if (against["kept"]["positions"].get<bool>())
    out << "its coordinates are those of the file, bit for bit\n";
  for (const auto& [name, exact] : against["kept"]["fields"].items())
    if (exact.get<bool>())
      out << "its values of " << printable(name) << " are those of the file, bit for bit\n";
}

void printReports(const OrderedJson& report, std::ostream& out) {
  if (!report.contains("segments")) return printReport(report, out);
  for (const OrderedJson& segment : report["segments"]) {
    out << printable(segment["log"].get<std::string>()) << "\n";
    printReport(segment["verified"], out);
  }
}

}  // namespace

int runVerify(const Words& words, Console& console) {
  namespace po = boost::program_options;
  po::options_description options("options");
  options.add_options()("against", po::value<std::string>(), "the mesh that the log was made from")(
      "json", "print one JSON object; of several logs an array");
  addReadOptions(options);
  const ParsedWords parsed(
      words,
      {"verify", "verify LOG.qtet|LIST.json... [--against IN] [--json]",
       "Checks every checksum, decodes every chunk and compares every level and field with what "
       "the manifest says. With --against the finest level\n"
       "must be the input's mesh cell for cell, positions within half a lattice step, fields "
       "within half a field step, and each value within the error that info states. A mesh that "
       "was read with options\n"
       "(--weld, --curved, ...) has to be read with the same ones. Where the log was made with "
       "--keep-order or\n"
       "--lossless, the numbering and the numbers themselves must be those of the file too, and "
       "what was proved is said. Each log of a list is checked, against the steps of its own "
       "times. A log with instants is compared with its own ones, unless --time chooses.\n"
       "Several logs stand under their names, and --json is an array of these objects, with input "
       "before the other members: {input, error} for one that failed. The exit code is the worst "
       "of all.",
       "  qtet verify fin.qtet\n  qtet verify run.qtet --against run.pvd\n  qtet verify fin.qtet "
       "--against fin.vtu --json\n"},
      options, {"LOG..."});
  if (parsed.helped(console)) return kExitOk;
  const std::optional<Input> input = inputOf(parsed);
  for (const auto& path : parsed.get<std::vector<std::string>>("LOG..."))
    if (isSegmentList(path) && input && input->options.time != ReadOptions().time)
      throw UsageError("'" + path + "' has times of its own; leave out --time");
  Progress progress(console);
  const auto report = [&](const std::string& path) -> Result<LogReport> {
    Result<OrderedJson> made =
        isSegmentList(path) ? verifyList(path, input, progress) : verifyLog(path, input, progress);
    progress.clear();
    if (!made) return std::unexpected(made.error());
    std::ostringstream text;
    printReports(*made, text);
    return LogReport{std::move(*made), text.str()};
  };
  return reportLogs(parsed, report, console);
}

}  // namespace qtet
