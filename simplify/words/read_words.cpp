#include "simplify/words/read_words.h"

#include <algorithm>
#include <charconv>
#include <iomanip>
#include <limits>
#include <sstream>

#include "simplify/read/options/time_steps.h"
#include "simplify/read/options/time_text.h"
#include "simplify/read/parts/file_family.h"

namespace qtet {
namespace {

constexpr int kMaxReadSeconds = 86'400;  // a day: longer is for ever

double numberOf(const std::string& text, double ifEmpty, const std::string& whole) {
  if (text.empty()) return ifEmpty;
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc{} || read.ptr != text.data() + text.size())
    throw UsageError("--threshold '" + whole + "': '" + text +
                     "' is no number; give FIELD=LOW:HIGH, either side may be empty");
  return value;
}

Threshold thresholdOf(const std::string& text) {
  const std::size_t equals = text.rfind('='),
                    colon = text.find(':', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || equals == 0 || colon == std::string::npos)
    throw UsageError("--threshold '" + text +
                     "' is not understood; give FIELD=LOW:HIGH, either side may be empty");
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return {text.substr(0, equals),
          numberOf(text.substr(equals + 1, colon - equals - 1), -kAny, text),
          numberOf(text.substr(colon + 1), kAny, text)};
}

void setWeld(const std::string& text, ReadOptions& options) {
  if (text == "none") {
    options.joinPieces = false;
    return;
  }
  double distance = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), distance);
  if (read.ec != std::errc{} || read.ptr != text.data() + text.size() || !(distance >= 0) ||
      distance > std::numeric_limits<double>::max())
    throw UsageError("--weld '" + text + "' is not understood; give a distance >= 0, or none");
  options.weld = distance;
}

}  // namespace

void addReadOptions(po::options_description& options, const char* time) {
  options.add_options()("curved", po::value<std::string>()->default_value("split"),
                        "quadratic cells and those of higher degree: split at all of their nodes, "
                        "or linear: their corners alone")(
      "weld", po::value<std::string>(),
      "a distance: join points within it (0: at the same place), as where an O-grid closes; none: "
      "keep pieces of a parallel result apart, which are joined at the points that they share")(
      "time", po::value<std::string>()->default_value(time),
      "of a series: a step's time, ~T (the nearest to T), first, last; or all, FROM:TO:EVERY, or "
      "times between commas: the steps' fields, as NAME@TIME")(
      "threshold", po::value<std::string>(),
      "only cells where a field lies within bounds: FIELD=LOW:HIGH, either side may be empty")(
      "plot3d", po::value<std::string>(), "the input is a PLOT3D grid; its solution file, or none")(
      "read-seconds", po::value<int>()->default_value(60),
      "how long VTK and meshio may read nothing, and our own readers may take beside a "
      "second for each 128 kB of the file")(
      "format", po::value<std::string>(),
      "the kind of file, where the name does not say it or is - (the standard input): vtu, msh, "
      "...");
}

ReadOptions readOptionsOf(const ParsedWords& parsed) {
  ReadOptions options;
  const auto curved = parsed.get<std::string>("curved");
  if (curved != "split" && curved != "linear")
    throw UsageError("--curved '" + curved + "' is not known; give split or linear");
  options.curved = curved == "split" ? CurvedCells::kSplit : CurvedCells::kLinear;
  if (parsed.has("weld")) setWeld(parsed.get<std::string>("weld"), options);
  if (parsed.has("format")) {
    options.format = parsed.get<std::string>("format");
    if (options.format.starts_with('.')) options.format.erase(0, 1);
    constexpr std::string_view kCompressed = ".gz";  // which the file itself shows
    if (options.format.ends_with(kCompressed))
      options.format.resize(options.format.size() - kCompressed.size());
  }
  options.time = timeWord(parsed.get<std::string>("time"));
  if (parsed.has("threshold"))
    options.threshold = thresholdOf(parsed.get<std::string>("threshold"));
  options.patience = std::chrono::seconds(parsed.integer("read-seconds", 1, kMaxReadSeconds));
  options.plot3d = parsed.has("plot3d");
  if (options.plot3d && parsed.get<std::string>("plot3d") != "none")
    options.plot3dSolution = parsed.get<std::string>("plot3d");
  return options;
}

std::vector<double> timesOf(const ParsedWords& parsed) {
  std::vector<double> out;
  if (!parsed.has("times")) return out;
  const auto text = parsed.get<std::string>("times");
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const auto time = plainTime(std::string_view(text).substr(at, end - at));
    if (!time) throw UsageError("--times '" + text + "' is no list of numbers between commas");
    out.push_back(*time);
    at = end + 1;
  }
  return out;
}

void addTimesOption(po::options_description& options) {
  options.add_options()("times", po::value<std::string>(),
                        "of numbered files: one time a file, between commas; without it their "
                        "TimeValue, else the numbers in their names");
}

std::string inputOf(const ParsedWords& parsed, ReadOptions& options) {
  const auto words = parsed.get<std::vector<std::string>>("IN...");
  options.listed.times = timesOf(parsed);
  if (words.size() == 1) return words.front();
  options.listed.files.assign(words.begin(), words.end());
  return familyOf(options.listed.files);
}

Words readWordsOf(const ParsedWords& parsed) {
  Words out;
  for (const char* name : {"curved", "time", "threshold", "plot3d", "format", "weld"}) {
    if (parsed.has(name))
      out.insert(out.end(), {"--" + std::string(name), parsed.get<std::string>(name)});
  }
  out.insert(out.end(), {"--read-seconds", std::to_string(parsed.get<int>("read-seconds"))});
  return out;
}

OrderedJson readReport(const ReadReport& report) {
  OrderedJson cells = OrderedJson::object();
  for (std::size_t type = 0; type < report.split.cells.size(); ++type) {
    if (report.split.cells[type] > 0)
      cells[cellTypeName(static_cast<std::uint8_t>(type))] = report.split.cells[type];
  }
  return {{"cells", cells},
          {"centrePoints", report.split.centrePoints},
          {"insideOutCells", report.split.insideOut},
          {"collapsedCells", report.split.collapsed},
          {"pieces", report.pieces},
          {"joinedPoints", report.joinedPoints},
          {"weldedPoints", report.weldedPoints},
          {"mendedFaces", report.mendedFaces}};
}

OrderedJson soundnessReport(const CleanReport& clean) {
  return {{"volume", clean.volume},
          {"box", clean.box},
          {"invertedCells", clean.invertedCells.count},
          {"components", clean.components}};
}

std::string soundnessText(const OrderedJson& mesh) {
  const auto short6 = [](double number) {
    std::ostringstream out;
    out << std::setprecision(6) << number;
    return out.str();
  };
  const auto corner = [&](const OrderedJson& place) {
    std::string out;
    for (const OrderedJson& x : place) out += (out.empty() ? "" : " ") + short6(x.get<double>());
    return out;
  };
  const auto inverted = mesh["invertedCells"].get<std::uint64_t>();
  return "volume " + short6(mesh["volume"].get<double>()) + ", box " + corner(mesh["box"][0]) +
         " to " + corner(mesh["box"][1]) + ", " +
         (inverted == 0 ? "no inverted cell"
                        : counted(inverted, "inverted cell", "inverted cells")) +
         ", " + counted(mesh["components"].get<std::uint64_t>(), "part", "parts");
}

}  // namespace qtet
