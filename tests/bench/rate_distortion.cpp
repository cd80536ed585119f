// Error against bytes: the prefixes of a log beside what one would send without it. Writes RATE.md
// and a picture a mesh.
//   rate_distortion [--out FOLDER] [--curve NAME=OPTIONS]... [MESH...]
//     MESH: a sample's name, a .vtu, or the name of one in the folder QTET_DATA. Without any: fin,
//     comb and bluntfin-welded.
//     --curve: a log made with these options of `qtet simplify` (several in one word: --curve
//     "shape=--boundary-weight 15000"). It may be given several times. Without it there is one log
//     of the default options. The ladder is made of the first log's levels.
// Every log has the first point field alone. The errors are those that the log's manifest states.
// On a few levels they are compared with errors measured from the decoded meshes
// (parts/direct_error.h). If the two differ, nothing is written.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "codec/files/atomic_file.h"
#include "simplify/log/write_mesh.h"
#include "simplify/samples/samples.h"
#include "tests/bench/parts/default_vtu.h"
#include "tests/bench/parts/direct_error.h"
#include "tests/bench/parts/error_plot.h"
#include "tests/bench/parts/rate_curves.h"
#include "tests/support/meshes.h"
#include "tests/support/paths/test_paths.h"

namespace qtet::bench {
namespace {

/// A picture in which the thing is recognised.
constexpr double kRecognisableBoundary = 0.01, kRecognisableField = 0.05;
constexpr std::array kCheckedRatios = {0.02, 0.1, 0.3};
constexpr std::size_t kDirectSamples = 4000;
/// How far the two measurements may be apart: so few samples leave this open, seldom 10 %. Errors
/// below the floor are as good as none.
constexpr double kTolerance = 0.25, kFloor = 2e-6;

struct Request {
  std::filesystem::path out;
  std::vector<std::pair<std::string, std::string>> curves;  ///< name and options
  std::vector<std::string> meshes;
};

template <class T>
T need(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text());
  return std::move(*result);
}

void write(const std::filesystem::path& path, const std::string& text) {
  if (const Status written = writeFileAtomically(path, Bytes(text.begin(), text.end())); !written)
    throw std::runtime_error(written.error().text());
}

/// One word of a shell's command line.
std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::filesystem::path fileOf(const std::string& mesh, const std::filesystem::path& folder) {
  if (std::filesystem::is_regular_file(mesh)) return mesh;
  if (const Result<TetMesh> sample = makeSample(mesh)) {
    const Bytes bytes = vtuBytes(*sample);
    write(folder / (mesh + ".vtu"), {bytes.begin(), bytes.end()});
    return folder / (mesh + ".vtu");
  }
  const char* data = std::getenv("QTET_DATA");
  const std::filesystem::path path = std::filesystem::path(data ? data : "") / (mesh + ".vtu");
  if (!data || !std::filesystem::exists(path))
    throw std::runtime_error("'" + mesh +
                             "' is neither a file nor a sample, nor has the folder QTET_DATA (" +
                             (data ? data : "not set") + ") such a .vtu");
  return path;
}

OpenedLog logOf(const std::filesystem::path& mesh, const std::string& field,
                const std::string& options, const std::filesystem::path& folder) {
  const std::filesystem::path log = folder / (mesh.stem().string() + ".qtet");
  const std::string command = quoted(testing::kTool) + " simplify " + quoted(mesh) + " -o " +
                              quoted(log) + " --fields " + quoted("point:" + field) +
                              " --measure all " + options + " >/dev/null";
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error("the tool failed (its message stands above): " + command);
  return need(openLog(log));
}

std::string number(double value, int digits = 3) {
  std::ostringstream out;
  out << std::setprecision(digits) << value;
  return out.str();
}
std::string whole(double value) { return std::to_string(std::llround(value)); }
std::string percent(double fraction) { return number(100 * fraction) + " %"; }

/// The known errors of a few levels beside those of the decoded meshes.
std::string checkedLevels(const OpenedLog& log) {
  const std::vector<ManifestLevel>& levels = log.manifest.levels;
  const LatticeMesh original =
      need(meshAtLevel(log.file, static_cast<std::uint32_t>(levels.size() - 1)));
  std::string out;
  for (const double ratio : kCheckedRatios) {
    const ManifestLevel& level = *std::prev(std::ranges::find_if(
        levels.begin() + 1, levels.end() - 1,
        [&](const ManifestLevel& l) { return l.tetrahedra > ratio * levels.back().tetrahedra; }));
    const DirectError direct =
        directError(original, need(meshAtLevel(log.file, level.level)), kDirectSamples);
    const auto compared = [&](const std::string& what, double known, double measured) {
      if (std::abs(known - measured) > kTolerance * std::max(known, measured) + kFloor)
        throw std::runtime_error(log.manifest.source + ": level " + std::to_string(level.level) +
                                 " has a known " + what + " error of " + percent(known) +
                                 ", and measured directly " + percent(measured));
      return what + " " + percent(known) + " (" + percent(measured) + ")";
    };
    out += (out.empty() ? "" : "\n") + std::string("- level ") + std::to_string(level.level) +
           ": " + compared("field", level.error->fields[0].rms, direct.field) + ", " +
           compared("boundary", level.error->boundaryMean(), direct.boundary);
  }
  return out;
}

/// The end of a row: at how many byte counts the curve is above the ladder, and where most.
std::string comparisonCells(const RateCurve& curve, const RateCurve& ladder) {
  std::ostringstream out;
  for (const Measure measure : {&RatePoint::field, &RatePoint::boundary}) {
    const Comparison found = compare(curve, ladder, measure);
    out << " " << found.above << " of " << found.places << " | ";
    if (found.worst > 0) out << number(found.worst) << " at " << whole(found.worstBytes) << " ";
    out << "|";
  }
  return out.str();
}

std::string row(const std::string& name, const RateCurve& curve, double vtuBytes) {
  const RatePoint seen = firstWithin(curve, kRecognisableBoundary, kRecognisableField);
  std::ostringstream out;
  out << "| " << name << " | " << whole(curve.front().bytes) << " | " << whole(seen.bytes) << " | "
      << percent(seen.bytes / vtuBytes) << " | " << whole(curve.back().bytes) << " | "
      << percent(curve.back().bytes / vtuBytes) << " |";
  return out.str();
}

/// Two pictures, one below the other.
std::string stacked(const std::string& upper, const std::string& lower) {
  const auto length = [](const std::string& svg, const std::string& name) {
    const std::string key = " " + name + "=\"";
    return std::stod(svg.substr(svg.find(key) + key.size()));
  };
  const double height = length(upper, "height"),
               width = std::max(length(upper, "width"), length(lower, "width"));
  std::ostringstream out;
  out << R"(<svg xmlns="http://www.w3.org/2000/svg" width=")" << width << R"(" height=")"
      << height + length(lower, "height") << "\">\n"
      << upper << "<svg y=\"" << height << '"' << lower.substr(std::string("<svg").size())
      << "</svg>\n";
  return out.str();
}

/// The curves of one mesh, as they are drawn: the logs, the ladder, and shipping the .vtu, which
/// shows nothing until it shows all.
struct Curves {
  std::vector<std::pair<std::string, RateCurve>> logs;
  RateCurve ladder;
  double vtuBytes = 0;

  [[nodiscard]] std::string svg(const std::string& title, Measure measure) const {
    std::vector<ErrorCurve> out;
    for (const auto& [name, curve] : logs) out.push_back(plotted(name, curve, measure));
    out.push_back(plotted("ladder", ladder, measure));
    double most = 0;
    for (const ErrorCurve& curve : out) most = std::max(most, curve.points.front().error);
    out.push_back({".vtu", false, {{vtuBytes, most}, {vtuBytes, 0}}});
    return errorPlotSvg(title, out);
  }
};

std::string section(const Request& request, const std::string& meshName,
                    const std::filesystem::path& folder) {
  const std::filesystem::path mesh = fileOf(meshName, folder);
  const std::string name = mesh.stem().string();
  const DefaultVtu vtu = need(defaultVtu(mesh));
  if (vtu.field.empty())
    throw std::runtime_error(mesh.string() +
                             " has no point field, and without one there is no error of it");
  Curves curves;
  curves.vtuBytes = static_cast<double>(vtu.bytes);
  std::string checked;
  for (const auto& [label, options] : request.curves) {
    const OpenedLog log = logOf(mesh, vtu.field, options, folder);
    curves.logs.emplace_back(label, need(logCurve(log)));
    if (curves.logs.size() > 1) continue;
    curves.ladder = need(ladderCurve(log));
    checked = checkedLevels(log);
  }
  write(request.out / ("rate_" + name + ".svg"),
        stacked(curves.svg(name + ": " + vtu.field + ", rms", &RatePoint::field),
                curves.svg(name + ": boundary, mean", &RatePoint::boundary)));

  std::ostringstream out;
  out << "\n## " << name << "\n\n"
      << vtu.cells << " tetrahedra, field " << vtu.field << "; the .vtu takes " << vtu.bytes
      << " bytes.\n\n"
      << "| curve | first picture, bytes | recognisable, bytes | of the .vtu | whole, bytes | of "
         "the .vtu | field above the ladder | worst "
         "| "
         "boundary above the ladder | worst |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [label, curve] : curves.logs)
    out << row(label, curve, curves.vtuBytes) << comparisonCells(curve, curves.ladder) << "\n";
  out << row("ladder", curves.ladder, curves.vtuBytes)
      << " | | | |\n\nKnown errors and, in brackets, those of the decoded meshes:\n\n"
      << checked << "\n\n![Error against bytes](rate_" << name << ".svg)\n";
  return out.str();
}

constexpr const char* kHead = R"(# Rate and distortion

Made by `make rate`; do not edit. The errors that a viewer shows after so many bytes, as the log's
manifest has them. *Field* is the rms error of the first point field over its range. *Boundary* is
the mean distance of the boundaries over the diagonal, the larger of both ways.

- *log*: `qtet simplify` with its default options and the first point field alone, at every prefix
  that ends a level.
- *ladder*: separate meshes, the log's own levels at 1/64, 1/16, 1/4 and 1 of the cells. The same
  coder codes each alone (a base mesh without records). They are fetched one after the other.
- *.vtu*: as VTK writes it by default, with the same field.
- *recognisable*: boundary within 1 %, field within 5 %. The bar is 2 % of the .vtu.
- *above the ladder*: the log has the larger error, or nothing to show yet while the ladder has. It
  is counted over all byte counts at which one of the two improves. *Worst*: how many times as large
  its error is, and at which byte, where both show something.
)";

void makeAll(const Request& request) {
  const std::filesystem::path folder = testing::freshFolder("rate_distortion");
  std::string document = kHead;
  for (const std::string& mesh : request.meshes) {
    document += section(request, mesh, folder);
    std::cerr << "rate_distortion: " << mesh << " is done\n";
  }
  write(request.out / "RATE.md", document);
  std::cout << (request.out / "RATE.md").string() << "\n";
}

Request requestOf(const std::vector<std::string>& words) {
  Request request;
  request.out = ".";
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool isOut = words[i] == "--out";
    if (!isOut && words[i] != "--curve") {
      if (words[i].starts_with("--"))
        throw std::runtime_error("unknown option " + words[i] + "; there are --out and --curve");
      request.meshes.push_back(words[i]);
      continue;
    }
    if (i + 1 == words.size()) throw std::runtime_error(words[i] + " needs a word after it");
    const std::string& value = words[++i];
    const std::size_t equals = value.find('=');
    if (!isOut && (equals == std::string::npos || equals == 0))
      throw std::runtime_error("--curve '" + value + "' has no name; write NAME=OPTIONS");
    isOut ? void(request.out = value)
          : void(request.curves.emplace_back(value.substr(0, equals), value.substr(equals + 1)));
  }
  if (request.curves.empty()) request.curves.emplace_back("log", "");
  if (request.meshes.empty()) {
    if (const char* data = std::getenv("QTET_DATA"); !data || *data == 0)
      throw std::runtime_error(
          "QTET_DATA is not set; it names the folder with comb.vtu and bluntfin-welded.vtu. For a "
          "sample alone: rate_distortion fin");
    request.meshes = {"fin", "comb", "bluntfin-welded"};
  }
  return request;
}

}  // namespace
}  // namespace qtet::bench

int main(int argc, char** argv) {
  try {
    qtet::bench::makeAll(qtet::bench::requestOf({argv + 1, argv + argc}));
  } catch (const std::exception& error) {
    std::cerr << "rate_distortion: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
