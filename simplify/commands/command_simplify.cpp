#include <chrono>
#include <iomanip>
#include <sstream>

#include "codec/files/atomic_file.h"
#include "codec/log/log_index.h"
#include "codec/log/log_manifest.h"
#include "codec/log/log_writer.h"
#include "proto/checksum.h"
#include "proto/limits.h"
#include "proto/manifest.h"
#include "simplify/clean/clean_mesh.h"
#include "simplify/commands/closing_report.h"
#include "simplify/commands/command_fusion.h"
#include "simplify/commands/command_line.h"
#include "simplify/commands/command_measure.h"
#include "simplify/commands/command_read.h"
#include "simplify/commands/progress.h"
#include "simplify/fuse/cost_parts.h"
#include "simplify/fuse/paper_fusion.h"
#include "simplify/log/kept_input.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/read/read_mesh.h"

namespace qtet {
namespace {

struct Request {
  std::string input, output;
  std::string algorithm;
  ReadOptions read;
  QuantiseOptions quantise;
  FusionRequest fusion;
  std::optional<MeasureOptions> measure;
  CodecId valueCodec = CodecId::kDraco;
  KeepOptions keep;
};

CodecId valueCodecOf(const std::string& name) {
  if (name == "draco") return CodecId::kDraco;
  if (name == "adaptive") return CodecId::kAdaptive;
  throw UsageError("--geometry-codec '" + name + "' is not known; give draco or adaptive");
}

Request requestOf(const ParsedWords& parsed) {
  Request request;
  request.input = parsed.get<std::string>("IN");
  request.output = parsed.get<std::string>("output");
  request.algorithm = parsed.get<std::string>("algorithm");
  if (request.algorithm != "qtet" && request.algorithm != "paper")
    throw UsageError("--algorithm '" + request.algorithm + "' is not known; give qtet or paper");
  request.read = readOptionsOf(parsed);
  request.read.fields = parseFieldNames(parsed.get<std::string>("fields"));
  request.quantise.positionBits =
      parsed.integer("position-bits", kMinPositionBits, kMaxPositionBits);
  request.quantise.fieldBits = parsed.integer("field-bits", kMinFieldBits, kMaxFieldBits);
  request.fusion = fusionRequestOf(parsed);
  if (request.algorithm == "paper" &&
      (request.fusion.regions || request.fusion.options.envelopeTolerance > 0 ||
       !request.fusion.fieldWeights.empty()))
    throw UsageError(
        "--algorithm paper knows no --preserve-regions, --envelope-tolerance or --field-weight; "
        "leave them out");
  if (request.algorithm == "paper" && request.fusion.options.bands.cellsPerPacket > 0)
    throw UsageError("--algorithm paper knows no --layout regions; leave it out");
  request.measure = measureOptionsOf(parsed);
  request.valueCodec = valueCodecOf(parsed.get<std::string>("geometry-codec"));
  request.keep = {parsed.has("keep-order"), parsed.has("lossless")};
  return request;
}

/// Wall time of each stage, by name, in the order of doing.
class Stopwatch {
 public:
  void lap(const std::string& name) {
    const Clock::time_point now = Clock::now();
    seconds_[name] = std::chrono::duration<double>(now - last_).count();
    last_ = now;
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
void addSizes(const EncodedLog& log, const Manifest& manifest, OrderedJson& report) {
  const LogStatistics& statistics = log.statistics;
  const std::uint64_t tetrahedra = manifest.levels.back().tetrahedra;
  const auto bits = [&](std::uint64_t bytes) {
    return 8.0 * static_cast<double>(bytes) / static_cast<double>(tetrahedra);
  };
  OrderedJson fieldBytes = OrderedJson::object(), fieldBits = OrderedJson::object();
  for (std::size_t f = 0; f < manifest.fields.size(); ++f) {
    fieldBytes[fieldKey(manifest, f)] = statistics.fieldBytes[f];
    fieldBits[fieldKey(manifest, f)] = bits(statistics.fieldBytes[f]);
  }
  report["bytes"] = log.bytes.size();
  report["bytesOf"] = {{"head", statistics.headBytes},
                       {"connectivity", statistics.structureBytes},
                       {"childBits", statistics.childBytes},
                       {"positions", statistics.positionBytes},
                       {"fields", fieldBytes}};
  report["bitsPerTetrahedron"] = {{"connectivity", bits(statistics.structureBytes)},
                                  {"positions", bits(statistics.positionBytes)},
                                  {"fields", fieldBits},
                                  {"total", bits(log.bytes.size())}};
}

/// The input on the lattice, and what was said on the way there.
struct Prepared {
  std::uint64_t cellsIn = 0;
  ReadReport read;
  CleanReport clean;
  QuantisedMesh quantised;
  Lattice lattice;  ///< the quantised mesh's, which the simplifier takes
  KeptInput kept;   ///< empty where nothing of the input is kept
  std::vector<std::string> fusionNotes;
  /// That the fusions were ordered by, where there were fields to weigh it against.
  std::optional<double> boundaryWeight;

  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> out = read.notes;
    for (const std::string& sentence : clean.sentences()) out.push_back(sentence);
    out.insert(out.end(), quantised.report.notes.begin(), quantised.report.notes.end());
    out.insert(out.end(), fusionNotes.begin(), fusionNotes.end());
    return out;
  }
};

/// Reads, cleans and quantises. The mesh in floats is gone afterwards: large meshes need the room.
Result<Prepared> prepare(const Request& request, Progress& progress, Stopwatch& watch) {
  progress.stage("reading " + request.input);
  Result<ReadMesh> read = readMesh(request.input, request.read);
  if (!read) return std::unexpected(read.error());
  watch.lap("read");
  Prepared out;
  out.cellsIn = read->mesh.tetrahedra.size();

  progress.stage("cleaning");
  const std::vector<Tetrahedron> asStored =
      request.keep.any() ? read->mesh.tetrahedra : std::vector<Tetrahedron>{};
  Result<CleanReport> cleaned = cleanMesh(read->mesh);
  if (!cleaned) return std::unexpected(cleaned.error());
  watch.lap("clean");

  progress.stage("quantising");
  Result<QuantisedMesh> quantised = quantise(read->mesh, request.quantise);
  if (!quantised) return std::unexpected(quantised.error());
  watch.lap("quantise");
  if (request.keep.any()) out.kept = {request.keep, asRead(read->mesh, asStored, *cleaned)};
  out.read = std::move(read->report);
  out.clean = std::move(*cleaned);
  out.quantised = std::move(*quantised);
  out.lattice = out.quantised.mesh.lattice;
  return out;
}

/// The known error of each level; with bounds, the history ends where they would be passed.
Result<std::vector<LevelError>> measure(const Request& request, FusionHistory& history,
                                        Progress& progress, Stopwatch& watch) {
  if (!request.measure) return {};
  progress.stage("measuring");
  MeasureOptions options = *request.measure;
  options.threads = request.fusion.options.threads;
  options.progress = [&](double fraction) { progress.update(fraction); };
  Result<std::vector<LevelError>> errors = measureLevels(history, options);
  watch.lap("measure");
  return errors;
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

/// Simplifies by the algorithm asked for; the paper's leaves its figures in `paper`.
Result<FusionHistory> fuseBy(const Request& request, LatticeMesh&& mesh,
                             const FusionOptions& options, OrderedJson& paper) {
  if (request.algorithm != "paper") return simplify(std::move(mesh), options);
  Result<PaperFusion> fused = simplifyAsThePaper(mesh, options);
  if (!fused) return std::unexpected(fused.error());
  paper = toJson(fused->figures);
  return std::move(fused->history);
}

/// Simplifies, measures, encodes and writes.
Result<EncodedLog> makeLog(const Request& request, Prepared& prepared, Progress& progress,
                           Stopwatch& watch, OrderedJson& paper) {
  progress.stage("simplifying");
  Result<FusionOptions> fusion =
      fusionOptionsFor(request.fusion, prepared.quantised, prepared.fusionNotes);
  if (!fusion) return std::unexpected(fusion.error());
  if (request.algorithm != "paper" &&
      !costPartsOf(prepared.quantised.mesh, fusion->cost.fieldWeights).empty())
    prepared.boundaryWeight = fusion->cost.boundaryWeight;
  fusion->progress = [&](double fraction) { progress.update(fraction); };
  Result<FusionHistory> history =
      fuseBy(request, std::move(prepared.quantised.mesh), *fusion, paper);
  if (!history) return std::unexpected(history.error());
  watch.lap("simplify");
  if (fusion->bands.cellsPerPacket > 0 && history->bands.ends.empty())
    prepared.fusionNotes.push_back(
        "the mesh is too small for more than one packet (--cells-per-packet): the log has the "
        "layout stream");
  const Result<std::vector<LevelError>> errors = measure(request, *history, progress, watch);
  if (!errors) return std::unexpected(errors.error());
  restoreMissing(*history, prepared.quantised.missing);

  progress.stage("encoding");
  LogWriterOptions options;
  options.source = std::filesystem::path(request.input).filename().string();
  options.generator = "qtet " QTET_VERSION;
  options.progress = fusion->progress;
  options.errors = *errors;
  options.valueCodec = request.valueCodec;
  Result<EncodedLog> log = encodeLog(*history, options);
  if (!log) return log;
  watch.lap("encode");
  if (request.keep.any()) {
    Result<Bytes> whole = withInput(*log, prepared.kept);
    if (!whole) return std::unexpected(whole.error());
    log->bytes = std::move(*whole);
    watch.lap("keep");
  }
  if (Status written = writeFileAtomically(request.output, log->bytes); !written)
    return std::unexpected(written.error());
  watch.lap("write");
  return log;
}

/// The counts are those of the bytes written, not of what was meant to be written.
Result<OrderedJson> reportOf(const Request& request, const Prepared& prepared,
                             const EncodedLog& log, const Stopwatch& watch) {
  const Result<LogIndex> index = LogIndex::parse(log.bytes);
  if (!index) return std::unexpected(index.error());
  const Result<Manifest> manifest = manifestOf(*index);
  if (!manifest) return std::unexpected(manifest.error());

  const QuantiseReport& quantised = prepared.quantised.report;
  const Lattice& lattice = prepared.lattice;
  const std::uint64_t full = manifest->levels.back().tetrahedra,
                      base = manifest->levels.front().tetrahedra;
  OrderedJson report = {
      {"input", request.input},
      {"output", request.output},
      {"algorithm", request.algorithm},
      {"digest", sha256Hex(log.bytes)},
      {"tetrahedra", {{"input", prepared.cellsIn}, {"full", full}, {"base", base}}},
      {"vertices", manifest->levels.back().vertices},
      {"percentRemoved", 100.0 * (1.0 - static_cast<double>(base) / static_cast<double>(full))},
      {"layout", manifest->layout},
      {"levels", manifest->levels.size() - 1},
      {"chunks", index->chunks.size()}};
  report["records"] = log.statistics.records;
  if (prepared.boundaryWeight) {
    report["boundaryWeight"] = *prepared.boundaryWeight;
    report["hullWeight"] = *prepared.boundaryWeight;  // its name in version 0.1, until 0.3
  }
  addSizes(log, *manifest, report);
  if (!index->closing.empty()) report["kept"] = closingJson(*index, *manifest);
  report["error"] = measureReport(request.measure, manifest->levels.front().error);
  report["lattice"] = {{"bits", lattice.bits},
                       {"requestedBits", quantised.requestedBits},
                       {"step", lattice.step},
                       {"origin", lattice.origin},
                       {"worseCells", toJson(quantised.worseCells)}};
  report["clean"] = toJson(prepared.clean);
  report["read"] = readReport(prepared.read);
  report["ignoredCells"] = prepared.read.ignoredCells;
  report["ignoredFields"] = prepared.read.ignoredFields;
  report["nonFiniteValues"] = quantised.nonFiniteValues;
  report["seconds"] = watch.seconds();
  report["notes"] = prepared.notes();
  return report;
}

Result<OrderedJson> run(const Request& request, Progress& progress) {
  Stopwatch watch;
  Result<Prepared> prepared = prepare(request, progress, watch);
  if (!prepared) return std::unexpected(prepared.error());
  OrderedJson paper;
  const Result<EncodedLog> log = makeLog(request, *prepared, progress, watch, paper);
  if (!log) return std::unexpected(log.error());
  Result<OrderedJson> report = reportOf(request, *prepared, *log, watch);
  if (report && !paper.is_null()) (*report)["paper"] = paper;
  return report;
}

void printReport(const OrderedJson& report, std::ostream& out) {
  const OrderedJson& bits = report["bitsPerTetrahedron"];
  out << std::fixed << std::setprecision(1) << printable(report["output"].get<std::string>())
      << ": " << counted(report["tetrahedra"]["full"], "tetrahedron", "tetrahedra")
      << ", of which the base mesh keeps " << grouped(report["tetrahedra"]["base"]) << " ("
      << report["percentRemoved"].get<double>() << " % removed), refined in "
      << counted(report["levels"], "level", "levels") << "\n"
      << grouped(report["bytes"]) << " bytes, " << std::setprecision(2)
      << bits["total"].get<double>() << " bits a tetrahedron: connectivity "
      << bits["connectivity"].get<double>() << ", positions " << bits["positions"].get<double>();
  for (const auto& [name, value] : bits["fields"].items())
    out << ", " << printable(name) << " " << value.get<double>();
  out << measureSentence(report["error"], report["bitsPerTetrahedron"]["fields"]);
  out << "\nlattice of " << report["lattice"]["bits"] << " bits an axis, step "
      << report["lattice"]["step"] << "; ";
  if (report.contains("boundaryWeight"))
    out << "boundary weight " << report["boundaryWeight"].get<double>() << "; ";
  out << std::setprecision(1) << report["seconds"]["total"].get<double>() << " s\n";
}

}  // namespace

int runSimplify(const Words& words, Console& console) {
  namespace po = boost::program_options;
  po::options_description options("options");
  options.add_options()("output,o", po::value<std::string>(),
                        "required: the log to write, NAME.qtet")(
      "algorithm", po::value<std::string>()->default_value("qtet"),
      "qtet, or paper: the paper's own loop, tetrahedra only, which ends near half of the cells")(
      "fields", po::value<std::string>()->default_value("all"), kFieldsHelp)(
      "position-bits", po::value<int>()->default_value(16),
      "bits of the lattice an axis, 4 to 28; raised where a cell would be flattened or inverted")(
      "field-bits", po::value<int>()->default_value(12),
      "bits of a float field's values, 1 to 28; integer fields are stored exactly")(
      "geometry-codec", po::value<std::string>()->default_value("draco"),
      "how positions and fields are coded: draco, or adaptive, which is 1 to 3 % smaller and which "
      "only qtet can read")("keep-order",
                            "keep the input's numbering of points, cells and their vertices: "
                            "extract gives it back at the last level")(
      "lossless",
      "keep the input's own coordinates and field values: extract gives them back bit for bit at "
      "the last level")("json", "print one JSON object");
  addReadOptions(options);
  addFusionOptions(options);
  addMeasureOptions(options);
  const ParsedWords parsed(
      words,
      {"simplify", "simplify IN -o OUT.qtet [options]",
       "Reads a volume mesh with its fields (.vtu, .vtk, .msh, Exodus, EnSight, CGNS, ...: see "
       "README.md), splits its cells into tetrahedra, cleans\n"
       "them, simplifies them level by level and writes the log,\n"
       "from which every level and the whole mesh come back.",
       "  qtet simplify fin.vtu -o fin.qtet\n  qtet simplify fin.vtu -o fin.qtet --fields "
       "Density,Velocity --field-bits 10 --json\n"
       "  qtet simplify ogrid.xyz --plot3d ogrid.q --weld 0 -o ogrid.qtet\n  qtet simplify run.pvd "
       "--time all -o run.qtet\n"},
      options, {"IN"});
  if (parsed.helped(console)) return kExitOk;
  const Request request = requestOf(parsed);
  const bool asJson = parsed.has("json");
  if (Status checked = checkOutput(request.output, ".qtet", request.input); !checked)
    return reportFailure(checked.error(), asJson, console);

  Progress progress(console);
  const Result<OrderedJson> report = run(request, progress);
  progress.clear();
  if (!report) return reportFailure(report.error(), asJson, console);
  for (const OrderedJson& note : (*report)["notes"]) console.note(note.get<std::string>());
  asJson ? printJson(*report, console) : printReport(*report, console.out);
  return kExitOk;
}

}  // namespace qtet
