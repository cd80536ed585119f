#include "simplify/produce/made_log_report.h"

#include <iomanip>
#include <sstream>

#include "simplify/produce/closing_report.h"
#include "simplify/words/columns.h"
#include "simplify/words/error_table.h"
#include "simplify/words/measure_words.h"
#include "simplify/words/read_words.h"

namespace qtet {
namespace {

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

/// " of 1,000,000,000", where the mesh was reduced before.
std::string reducedText(const OrderedJson& tetrahedra) {
  return tetrahedra.contains("original") ? " of " + grouped(tetrahedra["original"]) : "";
}

}  // namespace

OrderedJson madeLogReport(const SimplifyRequest& request, const ReadReport& read,
                          const PipelineReport& from, const WrittenLog& written,
                          const OrderedJson& seconds) {
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
  report["seconds"] = seconds;
  report["notes"] = withOptionNames(read.notes);
  for (const std::string& note : withOptionNames(from.notes)) report["notes"].push_back(note);
  report["warnings"] = withOptionNames(read.warnings);
  for (const std::string& warning : withOptionNames(from.warnings))
    report["warnings"].push_back(warning);
  if (from.paper) report["paper"] = toJson(*from.paper);
  if (manifest.original) report["tetrahedra"]["original"] = manifest.original->tetrahedra;
  return report;
}

void printMadeLog(const OrderedJson& report, std::ostream& out) {
  const OrderedJson& bits = report["bitsPerTetrahedron"];
  const std::size_t fields = bits["fields"].size();
  out << std::fixed << std::setprecision(1) << printable(report["output"].get<std::string>())
      << ": " << counted(report["tetrahedra"]["full"], "tetrahedron", "tetrahedra")
      << reducedText(report["tetrahedra"]) << ", of which the base mesh keeps "
      << grouped(report["tetrahedra"]["base"]) << " (" << report["percentRemoved"].get<double>()
      << " % removed), refined in " << counted(report["levels"], "level", "levels") << "\n"
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
