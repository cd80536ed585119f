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
  options.add_options()("output,o", po::value<std::string>(), ("required: the file to write, " + std::string(kWrittenEndings)).c_str())(
      "fields", po::value<std::string>()->default_value("all"),
      "all, none, or names between commas; point:NAME or cell:NAME is one of two fields with the same name");
  addReadOptions(options);
  const ParsedWords parsed(words,
                           {"convert", "convert IN -o OUT [options]",
                            "Reads a mesh of any format that simplify reads, or the last level of a log, and writes its tetrahedra and fields otherwise as they are: neither\n"
                            "cleaned nor put on a lattice (but for .glb and .drc, whose coordinates and fields have 16 bits). The kind of file is told by its name, as for\n"
                            "extract; .qtet files are made by simplify.",
                            "  qtet convert part.msh -o part.vtu\n  qtet convert part.vtu -o skin.stl\n  qtet convert part.qtet -o part.usda\n  qtet convert ogrid.xyz --plot3d ogrid.q --weld 0 -o ogrid.vtu\n"},
                           options, {"IN"});
  if (parsed.helped(console)) return kExitOk;
  const auto input = parsed.get<std::string>("IN"), output = parsed.get<std::string>("output");
  if (input.ends_with(".qtet")) return runExtract({input, "--ratio", "1", "--fields", parsed.get<std::string>("fields"), "-o", output}, console);
  if (Status checked = checkOutput(output, kWrittenEndings, input); !checked) return reportFailure(checked.error(), false, console);
  ReadOptions reading = readOptionsOf(parsed);
  reading.fields = parseFieldNames(parsed.get<std::string>("fields"));
  Progress progress(console);
  progress.stage("reading " + input);
  const Result<ReadMesh> read = readMesh(input, reading);
  progress.clear();
  if (!read) return reportFailure(read.error(), false, console);
  for (const std::string& note : read->report.notes) console.note(note);
  const Result<Bytes> bytes = meshFileBytes(read->mesh, output);
  if (!bytes) return reportFailure(bytes.error(), false, console);
  if (Status written = writeFileAtomically(output, *bytes); !written) return reportFailure(written.error(), false, console);
  console.out << output << ": " << read->mesh.tetrahedra.size() << " tetrahedra, " << read->mesh.points.size() << " points, " << read->mesh.fields.size()
              << " fields, " << bytes->size() << " bytes\n";
  return kExitOk;
}

}  // namespace qtet
