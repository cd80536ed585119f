#include "codec/atomic_file.h"
#include "simplify/command_line.h"
#include "simplify/command_read.h"
#include "simplify/progress.h"
#include "simplify/read_mesh.h"
#include "simplify/write_mesh.h"

namespace qtet {

int runConvert(const Words& words, Console& console) {
  namespace po = boost::program_options;
  po::options_description options("options");
  options.add_options()("output,o", po::value<std::string>(), "required: the .vtu file to write")(
      "fields", po::value<std::string>()->default_value("all"),
      "all, none, or names between commas; point:NAME or cell:NAME is one of two fields with the same name");
  addReadOptions(options);
  const ParsedWords parsed(words,
                           {"convert", "convert IN -o OUT.vtu [options]",
                            "Reads a mesh of any format that simplify reads and writes its tetrahedra and fields as a .vtu file, otherwise as they are:\n"
                            "neither cleaned nor put on a lattice.",
                            "  qtet convert part.msh -o part.vtu\n  qtet convert ogrid.xyz --plot3d ogrid.q --weld 0 -o ogrid.vtu\n"},
                           options, {"IN"});
  if (parsed.helped(console)) return kExitOk;
  const auto input = parsed.get<std::string>("IN"), output = parsed.get<std::string>("output");
  if (Status checked = checkOutput(output, ".vtu", input); !checked) return reportFailure(checked.error(), false, console);
  ReadOptions reading = readOptionsOf(parsed);
  reading.fields = parseFieldNames(parsed.get<std::string>("fields"));
  Progress progress(console.err, console.errIsTerminal);
  progress.stage("reading " + input);
  const Result<ReadMesh> read = readMesh(input, reading);
  progress.clear();
  if (!read) return reportFailure(read.error(), false, console);
  for (const std::string& note : read->report.notes) console.err << "qtet: note: " << note << "\n";
  const Bytes bytes = vtuBytes(read->mesh);
  if (Status written = writeFileAtomically(output, bytes); !written) return reportFailure(written.error(), false, console);
  console.out << output << ": " << read->mesh.tetrahedra.size() << " tetrahedra, " << read->mesh.points.size() << " points, " << read->mesh.fields.size()
              << " fields, " << bytes.size() << " bytes\n";
  return kExitOk;
}

}  // namespace qtet
