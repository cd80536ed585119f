#include <algorithm>

#include "simplify/commands/command_line.h"
#include "simplify/commands/output.h"
#include "simplify/log/write_mesh.h"
#include "simplify/samples/samples.h"

namespace qtet {
namespace {

std::string listOfSamples() {
  std::size_t widest = 0;
  for (const Sample& sample : samples()) widest = std::max(widest, sample.name.size());
  std::string out = "Writes a mesh that is computed, not read. NAME is one of:";
  for (const Sample& sample : samples()) {
    std::string name(sample.name);
    name.resize(widest, ' ');
    out += "\n  " + name + "  " + std::string(sample.description);
  }
  return out;
}

}  // namespace

int runSample(const Words& words, Console& console) {
  namespace po = boost::program_options;
  po::options_description options("options");
  options.add_options()("output,o", po::value<std::string>(),
                        "required: the .vtu file to write; or - for the standard output")(
      "cells", po::value<double>(),
      "at least so many tetrahedra, for samples that come in sizes (fin: up to 100,000,000)")(
      "steps", po::value<int>(),
      ("so many time steps of each field, 2 to " + std::to_string(kMaxSampleInstants) +
       " (fin, beam)")
          .c_str());
  addNoClobber(options);
  const ParsedWords parsed(
      words,
      {"sample", "sample NAME -o FILE.vtu [--cells N] [--steps N]", listOfSamples(),
       "  qtet sample box -o box.vtu\n  qtet sample fin --cells 1000000 -o fin.vtu\n"
       "  qtet sample fin --steps 40 -o run.vtu\n"
       "  qtet sample beam --steps 40 -o swing.vtu\n"},
      options, {"NAME"});
  if (parsed.helped(console)) return kExitOk;

  const Output output = outputOf(parsed, console);
  if (Status checked = checkOutput(output, ".vtu"); !checked)
    return reportFailure(checked.error(), false, console);
  std::optional<std::uint64_t> cells;
  if (parsed.has("cells")) cells = static_cast<std::uint64_t>(parsed.number("cells", 1, 1e12));
  const auto steps =
      parsed.has("steps")
          ? static_cast<std::uint32_t>(parsed.integer("steps", 2, kMaxSampleInstants))
          : 0;
  const Result<TetMesh> mesh = makeSample(parsed.get<std::string>("NAME"), cells, steps);
  if (!mesh) throw UsageError(mesh.error().message);
  const Bytes bytes = vtuBytes(*mesh);
  if (Status written = writeOutput(output, bytes); !written)
    return reportFailure(written.error(), false, console);
  reportOutput(output,
               output.name() + ": " +
                   counted(mesh->tetrahedra.size(), "tetrahedron", "tetrahedra") + ", " +
                   counted(mesh->points.size(), "point", "points") + ", " +
                   counted(mesh->fields.size(), "field", "fields") + ", " + grouped(bytes.size()) +
                   " bytes\n",
               console);
  return kExitOk;
}

}  // namespace qtet
