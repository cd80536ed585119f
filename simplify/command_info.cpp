#include <iomanip>

#include "simplify/command_line.h"
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
          {"levels", levelsJson(log)}};
}

void printInfo(const OrderedJson& info, std::ostream& out) {
  out << "digest   " << info["digest"].get<std::string>() << "\nsource   " << info["source"].get<std::string>() << "  ("
      << info["generator"].get<std::string>() << ")\nbytes    " << info["bytes"] << " in " << info["chunks"] << " chunks, the first "
      << info["headBytes"] << " are header, manifest and table\nlattice  " << info["lattice"]["bits"] << " bits an axis, step "
      << info["lattice"]["step"] << "\n";
  for (const OrderedJson& field : info["fields"]) {
    out << (field["association"] == "cell" ? "of cells " : "field    ") << field["name"].get<std::string>() << ": "
        << field["type"].get<std::string>() << " x " << field["components"] << ", " << field["range"][0] << " to " << field["range"][1]
        << ", " << field["bits"] << " bits, step " << field["step"] << ", " << field["bytes"] << " bytes\n";
  }
  out << "\nlevel  tetrahedra    vertices       bytes  cumulative\n";
  for (const OrderedJson& level : info["levels"]) {
    out << std::setw(5) << level["level"].get<std::uint64_t>() << std::setw(12) << level["tetrahedra"].get<std::uint64_t>() << std::setw(12)
        << level["vertices"].get<std::uint64_t>() << std::setw(12) << level["bytes"].get<std::uint64_t>() << std::setw(12)
        << level["cumulativeBytes"].get<std::uint64_t>() << "\n";
  }
}

}  // namespace

int runInfo(const Words& words, Console& console) {
  namespace po = boost::program_options;
  po::options_description options("options");
  options.add_options()("json", "print one JSON object");
  const ParsedWords parsed(
      words,
      {"info", "info LOG.qtet [--json]",
       "Says what a log holds: digest, lattice, fields, and for each level its cells and bytes. Level 0 is the base mesh,\n"
       "the last level the input's mesh; `cumulative` is the length of the file's prefix that holds a level.",
       "  qtet info fin.qtet\n  qtet info fin.qtet --json | jq '.levels[0]'\n"},
      options, {"LOG"});
  if (parsed.helped(console)) return kExitOk;

  const Result<OpenedLog> log = openLog(parsed.get<std::string>("LOG"));
  if (!log) return reportFailure(log.error(), parsed.has("json"), console);
  const OrderedJson info = infoJson(*log);
  parsed.has("json") ? printJson(info, console) : printInfo(info, console.out);
  return kExitOk;
}

}  // namespace qtet
