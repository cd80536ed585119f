#include <iomanip>
#include <sstream>

#include "proto/number_text.h"
#include "simplify/commands/commands.h"
#include "simplify/commands/verified_log.h"
#include "simplify/log/opened_list.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"
#include "simplify/words/progress.h"
#include "simplify/words/read_words.h"
#include "simplify/words/several_logs.h"

namespace qtet {
namespace {

std::optional<ComparedInput> inputOf(const ParsedWords& parsed) {
  if (!parsed.has("against")) return std::nullopt;
  return ComparedInput{parsed.get<std::string>("against"), readOptionsOf(parsed)};
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

CommandHelp verifyHelp() {
  return {"verify", "verify LOG.qtet|LIST.json... [--against IN] [--json]",
          R"(Checks every checksum, decodes every chunk and compares every level and field with what
the manifest says.
With --against the finest level must be the input's mesh cell for cell, positions within half a
lattice step, fields within half a field step, and each value within the error that info states.
A mesh that was read with options (--weld, --curved, ...) has to be read with the same ones.
Where the log was made with --keep-order or
--lossless, the numbering and the numbers themselves must be those of the file too, and what was
proved is said. Each log of a list is checked, against the steps of its own times.
A log with instants is compared with its own ones, unless --time chooses.
Several logs stand under their names, and --json is an array of these objects, with input before the
other members: {input, error} for one that failed. The exit code is the worst of all.)",
          R"(  qtet verify fin.qtet
  qtet verify run.qtet --against run.pvd
  qtet verify fin.qtet --against fin.vtu --json
)"};
}

}  // namespace

int runVerify(const Words& words, Console& console) {
  po::options_description options("options");
  options.add_options()("against", po::value<std::string>(), "the mesh that the log was made from")(
      "json", "print one JSON object; of several logs an array");
  addReadOptions(options);
  const ParsedWords parsed(words, verifyHelp(), options, {"LOG..."});
  if (parsed.helped(console)) return kExitOk;
  const std::optional<ComparedInput> input = inputOf(parsed);
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
