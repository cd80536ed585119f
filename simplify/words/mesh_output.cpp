#include "simplify/words/mesh_output.h"

#include "simplify/words/output.h"

namespace qtet {

void addMeshOutputOptions(po::options_description& options) {
  options.add_options()("output,o", po::value<std::string>(),
                        ("required: the file to write, " + std::string(kWrittenEndings) +
                         "; or - for the standard output")
                            .c_str())(
      "to", po::value<std::string>(),
      "the kind of file, where the name does not say it or is -: vtu, glb, ...")(
      "no-draco",
      "a .glb of plain numbers, larger, for programs without KHR_draco_mesh_compression (VTK)")(
      "json", "print one JSON object");
  addNoClobber(options);
}

Result<MeshOutput> meshOutputOf(const ParsedWords& parsed, const std::string& input,
                                const std::string& endings) {
  MeshOutput out{
      parsed.get<std::string>("output"), {}, false, parsed.has("json"), parsed.has("no-clobber")};
  out.isStandardOutput = out.file == "-";
  if (out.isStandardOutput && out.asJson)
    throw UsageError(
        "-o - and --json both want the standard output; give the output a name, or leave --json "
        "out");
  out.ending = out.file.extension().string();
  if (parsed.has("to")) {
    const auto kind = parsed.get<std::string>("to");
    out.ending = (kind.starts_with('.') ? "" : ".") + kind;
  } else if (out.isStandardOutput) {
    throw UsageError(
        "-o - is the standard output, which has no name: say with --to what kind of file to write, "
        "for example --to vtu");
  }
  out.options.draco = !parsed.has("no-draco");
  if (!out.options.draco && out.ending != ".glb")
    throw UsageError("--no-draco is for .glb; leave it out of a " + out.ending);
  // Judged by a name that has the ending, in the folder that is meant.
  std::filesystem::path judged = out.isStandardOutput ? "standard-output" : out.file;
  judged.replace_extension(out.ending);
  if (out.isStandardOutput) judged = std::filesystem::temp_directory_path() / judged;
  if (Status checked = checkOutput({judged}, endings, input); !checked)
    return std::unexpected(checked.error());
  if (Status s = out.isStandardOutput ? checkNoTerminal() : checkKeepsOld({out.file, out.keepsOld});
      !s)
    return std::unexpected(s.error());
  if (!out.isStandardOutput && judged != out.file) {
    std::error_code code;
    if (std::filesystem::equivalent(out.file, input, code))
      return fail(ErrorCode::kIo,
                  "the output " + out.file.string() +
                      " is the input itself; choose another name, the input is never overwritten");
  }
  return out;
}

Status writeMeshOutput(const MeshOutput& output, std::span<const std::uint8_t> bytes,
                       const MeshOutputReport& report, Console& console) {
  if (output.isStandardOutput) {
    console.out.write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
    console.note(report.sentence + ", " + std::to_string(bytes.size()) + " bytes");
    return {};
  }
  if (Status written = writeOutput({output.file, output.keepsOld}, bytes); !written) return written;
  reportMeshOutput(output, bytes.size(), report, console);
  return {};
}

void reportMeshOutput(const MeshOutput& output, std::uint64_t bytes, const MeshOutputReport& report,
                      Console& console) {
  if (!output.asJson) {
    console.out << output.file.string() << ": " << report.sentence << ", " << bytes << " bytes\n";
    return;
  }
  OrderedJson json = {
      {"output", output.file.string()}, {"kind", output.ending.substr(1)}, {"bytes", bytes}};
  json.update(report.json);
  printJson(json, console);
}

}  // namespace qtet
