#include "simplify/commands/commands.h"
#include "simplify/log/write_mesh.h"
#include "simplify/read/read_mesh.h"
#include "simplify/words/field_names.h"
#include "simplify/words/mesh_output.h"
#include "simplify/words/progress.h"
#include "simplify/words/read_words.h"

namespace qtet {
namespace {

MeshOutputReport reportOf(const std::string& input, const ReadMesh& read,
                          const std::string& ending) {
  const TetMesh& mesh = read.mesh;
  return {counted(mesh.tetrahedra.size(), "tetrahedron", "tetrahedra") + ", " +
              counted(mesh.points.size(), "point", "points") + ", " +
              counted(mesh.fields.size(), "field", "fields"),
          {{"tetrahedra", mesh.tetrahedra.size()},
           {"vertices", mesh.points.size()},
           {"fields", writtenFieldsJson(mesh.fields, ending)},
           {"input", input},
           {"notes", withOptionNames(read.report.notes)}}};
}

CommandHelp convertHelp() {
  return {"convert", "convert IN -o OUT [options]",
          R"(Reads a mesh of any format that simplify reads, or the last level of a log, and writes
its tetrahedra and fields otherwise as they are: neither cleaned nor put on a lattice (but for .glb
and .drc, whose coordinates and fields have 16 bits).
The kind of file follows from its name, as for extract; .qtet files are made by simplify.
--json: output, kind, bytes, tetrahedra, vertices, fields [{name, association, components, type}]
that the file holds, input, notes; of a log what extract says.)",
          R"(  qtet convert part.msh -o part.vtu
  qtet convert part.vtu -o skin.obj
  qtet convert part.qtet -o part.usda
  qtet convert - --format msh --to vtu -o - <part.msh >part.vtu
  qtet convert ogrid.xyz --plot3d ogrid.q --weld 0 -o ogrid.vtu
)"};
}

}  // namespace

int runConvert(const Words& words, Console& console) {
  po::options_description options("options");
  addMeshOutputOptions(options);
  options.add_options()("fields", po::value<std::string>()->default_value("all"), kFieldsHelp)(
      "original-ids",
      "add the cell field OriginalCellId: which cell of the input each tetrahedron was split from");
  addReadOptions(options);
  const ParsedWords parsed(words, convertHelp(), options, {"IN"});
  if (parsed.helped(console)) return kExitOk;
  const auto input = parsed.get<std::string>("IN");
  if (input.ends_with(".qtet")) {
    Words extract{input,
                  "--ratio",
                  "1",
                  "--fields",
                  parsed.get<std::string>("fields"),
                  "-o",
                  parsed.get<std::string>("output")};
    if (parsed.has("to")) extract.insert(extract.end(), {"--to", parsed.get<std::string>("to")});
    for (const char* same : {"json", "no-draco", "no-clobber"})
      if (parsed.has(same)) extract.push_back("--" + std::string(same));
    return runExtract(extract, console);
  }
  const Result<MeshOutput> output = meshOutputOf(parsed, input);
  const bool asJson = parsed.has("json");
  if (!output) return reportFailure(output.error(), asJson, console);
  ReadOptions reading = readOptionsOf(parsed);
  reading.fields = parseFieldNames(parsed.get<std::string>("fields"));
  reading.originalIds = parsed.has("original-ids");
  Progress progress(console);
  progress.stage("reading " + input);
  const Result<ReadMesh> read = readMesh(input, reading);
  progress.clear();
  if (!read) return reportFailure(read.error(), asJson, console);
  for (const std::string& note : read->report.notes) console.note(note);
  for (const std::string& warning : read->report.warnings) console.warn(warning);
  const Result<Bytes> bytes = meshFileBytes(read->mesh, "mesh" + output->ending, output->options);
  const Status written =
      writeMeshOutput(*output, *bytes, reportOf(input, *read, output->ending), console);
  return written ? kExitOk : reportFailure(written.error(), asJson, console);
}

}  // namespace qtet
