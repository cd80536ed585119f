#include "codec/atomic_file.h"
#include "codec/log_levels.h"
#include "simplify/closing_report.h"
#include "simplify/command_line.h"
#include "simplify/error_plot.h"
#include "simplify/svg_picture.h"
#include "simplify/error_table.h"
#include "simplify/opened_log.h"

namespace qtet {
namespace {

OrderedJson infoJson(const OpenedLog& log) {
  const Manifest& manifest = log.manifest;
  OrderedJson fields = OrderedJson::array();
  for (std::size_t f = 0; f < manifest.fields.size(); ++f) {
    const ManifestField& field = manifest.fields[f];
    std::uint64_t bytes = 0;
    for (const ChunkEntry& chunk : log.file.index().chunks) bytes += chunk.blocks[kFirstFieldPart + f].size;
    fields.push_back({{"name", field.name},
                      {"components", field.components},
                      {"type", field.type},
                      {"association", field.association},
                      {"bits", field.bits},
                      {"step", field.step},
                      {"minimum", field.minimum},
                      {"range", field.range},
                      {"gaps", field.gaps},
                      {"bytes", bytes}});
  }
  return {{"digest", log.file.digest()},
          {"generator", manifest.generator},
          {"source", manifest.source},
          {"layout", manifest.layout},
          {"bytes", log.file.bytes().size()},
          {"headBytes", log.file.index().headBytes()},
          {"chunks", log.file.index().chunks.size()},
          {"lattice", {{"bits", manifest.latticeBits}, {"step", manifest.latticeStep}, {"origin", manifest.latticeOrigin}}},
          {"fields", fields},
          {"kept", closingJson(log.file.index(), manifest)},
          {"levels", levelsJson(log.manifest, log.file.index())}};
}

void printHead(const OrderedJson& info, std::ostream& out) {
  out << "digest   " << info["digest"].get<std::string>() << "\nsource   " << info["source"].get<std::string>() << "  ("
      << info["generator"].get<std::string>() << ")\nbytes    " << info["bytes"] << " in " << info["chunks"] << " chunks, the first "
      << info["headBytes"] << " are header, manifest and table\nlattice  " << info["lattice"]["bits"] << " bits an axis, step "
      << info["lattice"]["step"] << "\n";
  for (const OrderedJson& field : info["fields"]) {
    out << (field["association"] == "cell" ? "of cells " : "field    ") << field["name"].get<std::string>() << ": "
        << field["type"].get<std::string>() << " x " << field["components"] << ", " << field["range"][0] << " to " << field["range"][1]
        << ", " << field["bits"] << " bits, step " << field["step"] << ", " << field["bytes"] << " bytes\n";
  }
}

void printKept(const OrderedJson& kept, std::ostream& out) {
  for (const auto& [what, bytes] : kept.items()) out << "kept     " << what << ": " << bytes << " bytes\n";
}

// Pixels of a PNG to one of the picture's own: sharp on a screen of today and in print.
constexpr double kPlotScale = 2;

Status checkPlot(const std::string& plot, const std::string& input) { return checkOutput(plot, plot.ends_with(".png") ? ".png" : ".svg", input); }

Status writePlot(const OpenedLog& log, const std::filesystem::path& file, const std::string& title) {
  std::vector<std::uint64_t> bytes;
  for (std::size_t level = 0; level < log.manifest.levels.size(); ++level) bytes.push_back(log.prefixBytes(level));
  const Result<std::vector<ErrorCurve>> curves = errorCurves(log.manifest, bytes);
  if (!curves) return std::unexpected(curves.error());
  const std::string svg = errorPlotSvg(title, *curves);
  if (file.extension() != ".png") return writeFileAtomically(file, Bytes(svg.begin(), svg.end()));
  const Result<Bytes> png = pngOf(svg, kPlotScale);
  return png ? writeFileAtomically(file, *png) : std::unexpected(png.error());
}

}  // namespace

int runInfo(const Words& words, Console& console) {
  namespace po = boost::program_options;
  po::options_description options("options");
  options.add_options()("json", "print one JSON object")("plot", po::value<std::string>(), "draw error against bytes into this file, NAME.svg or NAME.png");
  const ParsedWords parsed(
      words,
      {"info", "info LOG.qtet [--plot FILE.svg|FILE.png] [--json]",
       "Says what a log holds: digest, lattice, fields, and for each level its cells and bytes. Level 0 is the base mesh,\n"
       "the last level the input's mesh; `cumulative` is the length of the file's prefix that holds a level. Where the log tells them,\n"
       "the errors against the original follow: of the boundary in per cent of the diagonal (the worse one of both ways), the volume that is\n"
       "left, and of each field in per cent of its range.",
       "  qtet info fin.qtet\n  qtet info fin.qtet --plot fin.svg\n  qtet info fin.qtet --json | jq '.levels[0]'\n"},
      options, {"LOG"});
  if (parsed.helped(console)) return kExitOk;
  const bool asJson = parsed.has("json");
  const auto input = parsed.get<std::string>("LOG");
  const auto plot = parsed.has("plot") ? parsed.get<std::string>("plot") : "";
  if (parsed.has("plot"))
    if (Status checked = checkPlot(plot, input); !checked) return reportFailure(checked.error(), asJson, console);

  const Result<OpenedLog> log = openLog(input);
  if (!log) return reportFailure(log.error(), asJson, console);
  if (parsed.has("plot"))
    if (Status written = writePlot(*log, plot, log->manifest.source); !written) return reportFailure(written.error(), asJson, console);
  const OrderedJson info = infoJson(*log);
  if (asJson) {
    printJson(info, console);
  } else {
    printHead(info, console.out);
    printKept(info["kept"], console.out);
    console.out << "\n" << levelTable(log->manifest, info["levels"]);
  }
  return kExitOk;
}

}  // namespace qtet
