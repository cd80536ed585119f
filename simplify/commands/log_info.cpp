#include "simplify/commands/log_info.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "codec/log/log_levels.h"
#include "proto/level_error_json.h"
#include "proto/rounding_error.h"
#include "simplify/log/opened_log.h"
#include "simplify/produce/closing_report.h"
#include "simplify/series/series.h"
#include "simplify/words/columns.h"
#include "simplify/words/error_table.h"

namespace qtet {
namespace {

OrderedJson infoJson(const OpenedLog& log) {
  const Manifest& manifest = log.manifest;
  OrderedJson fields = OrderedJson::array();
  for (std::size_t f = 0; f < manifest.fields.size(); ++f) {
    const ManifestField& field = manifest.fields[f];
    std::uint64_t bytes = 0;
    for (const ChunkEntry& chunk : log.file.chunks())
      bytes += chunk.blocks[kFirstFieldPart + f].size;
    fields.push_back({{"name", field.name},
                      {"components", field.components},
                      {"type", field.type},
                      {"association", field.association},
                      {"bits", field.bits},
                      {"step", field.step},
                      {"largestRoundingError", largestRoundingError(field)},
                      {"minimum", field.minimum},
                      {"range", field.range},
                      {"missingValues", field.hasMissing},
                      {"bytes", bytes}});
    if (const auto unit = unitOf(manifest, field.name); !unit.empty()) fields.back()["unit"] = unit;
  }
  OrderedJson out = {{"digest", log.file.digest()},
                     {"generator", manifest.generator},
                     {"source", manifest.source},
                     {"bytes", log.file.bytes().size()},
                     {"headBytes", log.file.headBytes()},
                     {"chunks", log.file.chunks().size()},
                     {"lattice",
                      {{"bits", manifest.latticeBits},
                       {"step", manifest.latticeStep},
                       {"origin", manifest.latticeOrigin}}},
                     {"timeUnit", timeUnit(manifest)},
                     {"fields", fields},
                     {"labels", toJson(manifest.labels)},
                     {"kept", closingJson(log.file.closingBlocks(), manifest)},
                     {"levels", levelsJson(log.manifest, log.file.index())}};
  if (manifest.original)
    out["original"] = {{"tetrahedra", manifest.original->tetrahedra},
                       {"vertices", manifest.original->vertices}};
  if (timeUnit(manifest).empty()) out.erase("timeUnit");
  if (manifest.labels.empty()) out.erase("labels");
  return out;
}

/// Digits of a number for people; --json has them all, of which a double has 17 at most.
constexpr int kBriefDigits = 6, kAllDigits = 17;
constexpr double kBriefEnd = 1e6;  ///< the first whole number with more digits

std::string brief(double number) {
  std::ostringstream out;
  out << std::setprecision(kBriefDigits) << number;
  return out.str();
}

/// How far values of the last level may be from the input's. Those of a closing block are its own.
std::string withinText(const OpenedLog& log, std::size_t field) {
  const bool isKept =
      std::ranges::any_of(log.file.closingBlocks(), [&](const ClosingBlock& closing) {
        return closing.kind == ClosingKind::kExactField && closing.field == field;
      });
  const double error = largestRoundingError(log.manifest.fields[field]);
  return isKept || error == 0 ? "exact" : brief(error);
}

/// A coordinate with all digits that a lattice of this step has, six at least.
std::string coordinate(double x, double step) {
  const double steps = step > 0 ? std::abs(x) / step : 0;
  std::ostringstream out;
  int digits = kBriefDigits;
  for (double known = kBriefEnd; known <= steps && digits < kAllDigits; known *= 10) ++digits;
  out << std::setprecision(digits) << x;
  return out.str();
}

/// "(0, 4600000.25, -3)": the lattice's lowest corner.
std::string originText(const Manifest& manifest) {
  std::string out;
  for (const double x : manifest.latticeOrigin)
    out += (out.empty() ? "(" : ", ") + coordinate(x, manifest.latticeStep);
  return out + ")";
}

/// ": 1 = steel, 2 = oil, and 12 more"; empty without names.
std::string labelText(const LabelNames& names) {
  constexpr std::size_t kShown = 8;
  std::string out;
  std::size_t shown = 0;
  for (const auto& [value, name] : names) {
    if (shown == kShown) return out + ", and " + std::to_string(names.size() - shown) + " more";
    out += (shown++ == 0 ? ": " : ", ") + std::to_string(value) + " = " + name;
  }
  return out;
}

/// A line of the head: what it is, bright where colours are allowed, and what there is to say.
void line(std::ostream& out, bool colours, const std::string& what, const std::string& said) {
  constexpr std::size_t kWidth = 10;
  out << (colours ? "\033[1m" : "") << what << (colours ? "\033[0m" : "")
      << std::string(kWidth - std::min(what.size(), kWidth - 1), ' ') << printable(said) << "\n";
}

void printHead(const OpenedLog& log, const OrderedJson& info, std::size_t mostFields,
               std::ostream& out, bool colours) {
  const auto add = [&](const std::string& what, const std::string& said) {
    line(out, colours, what, said);
  };
  const ManifestLevel& last = log.manifest.levels.back();
  const std::uint64_t bytes = info["bytes"];
  add("source", log.manifest.source + "  (" + log.manifest.generator + ")");
  add("mesh", counted(last.tetrahedra, "tetrahedron", "tetrahedra") + ", " +
                  counted(last.vertices, "vertex", "vertices") + ", " +
                  counted(last.boundaryTriangles, "boundary triangle", "boundary triangles") +
                  ", levels 0 to " + std::to_string(log.manifest.levels.size() - 1));
  if (const auto& original = log.manifest.original)
    add("original", counted(original->tetrahedra, "tetrahedron", "tetrahedra") + ", " +
                        counted(original->vertices, "vertex", "vertices") +
                        "; the mesh was reduced before the log was made");
  add("bytes", grouped(bytes) + " in " + counted(info["chunks"], "chunk", "chunks") + ", " +
                   brief(8.0 * static_cast<double>(bytes) / std::max(1u, last.tetrahedra)) +
                   " bits a tetrahedron; the first " + grouped(info["headBytes"]) +
                   " are header, manifest and table");
  add("lattice", std::to_string(log.manifest.latticeBits) + " bits an axis, step " +
                     brief(log.manifest.latticeStep) + ", from " + originText(log.manifest));
  add("digest", info["digest"]);
  for (const auto& [what, size] : info["kept"].items())
    add("kept", what + ": " + grouped(size) + " bytes");
  for (const Series& series : log.manifest.series)
    add("series", series.name + ": " + std::to_string(series.fields.size()) + " instants, " +
                      brief(series.times.front()) + " to " + brief(series.times.back()) +
                      (timeUnit(log.manifest).empty() ? "" : " ") +
                      std::string(timeUnit(log.manifest)));
  for (const auto& [name, values] : log.manifest.labels) add("label", name + labelText(values));
  if (info["fields"].empty()) return;
  out << "\n";
  std::vector<std::vector<std::string>> rows{
      {"field", "of", "type", "least", "most", "bits", "step", "within", "bytes"}};
  for (const OrderedJson& field : info["fields"]) {
    if (rows.size() > mostFields) break;
    const auto components = field["components"].get<std::uint32_t>();
    rows.push_back({printable(field["name"].get<std::string>()),
                    field["association"] == "cell" ? "cells" : "points",
                    field["type"].get<std::string>() +
                        (components > 1 ? " x " + std::to_string(components) : ""),
                    brief(field["range"][0]), brief(field["range"][1]),
                    std::to_string(field["bits"].get<int>()), brief(field["step"]),
                    withinText(log, rows.size() - 1), grouped(field["bytes"])});
  }
  if (std::ranges::any_of(info["fields"],
                          [](const OrderedJson& f) { return f.contains("unit"); })) {
    rows[0].emplace_back("unit");
    for (std::size_t row = 1; row < rows.size(); ++row)
      rows[row].push_back(printable(info["fields"][row - 1].value("unit", "")));
  }
  out << columns(rows);
  if (mostFields == kShownFields) out << moreFields(info["fields"].size(), "--all shows them");
}

}  // namespace

Result<LogReport> logReport(const std::string& path, bool all, bool colours) {
  const Result<OpenedLog> log = openLog(path);
  if (!log) return std::unexpected(log.error());
  LogReport out{infoJson(*log), ""};
  const std::size_t levels = log->manifest.levels.size();
  const std::size_t most = all ? levels : kShownLevels;
  const std::size_t mostFields = all ? log->manifest.fields.size() : kShownFields;
  std::ostringstream text;
  printHead(*log, out.json, mostFields, text, colours);
  text << "\n" << levelTable(log->manifest, out.json["levels"], most, mostFields);
  if (levels > most) text << "\n--all shows all " << levels << " levels\n";
  out.text = text.str();
  return out;
}

}  // namespace qtet
