// The mesh file that a command writes, and the report about it.
#pragma once

#include <boost/program_options.hpp>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "codec/files/mesh_file.h"
#include "simplify/words/json_report.h"
#include "simplify/words/parsed_words.h"

namespace qtet {

/// A mesh file to write: its kind, and its name or the standard output ("-" with --to).
struct MeshOutput {
  std::filesystem::path file;
  std::string ending;  ///< with its dot
  bool isStandardOutput = false;
  bool asJson = false;    ///< reports it as one JSON object
  bool keepsOld = false;  ///< --no-clobber
  MeshFileOptions options{};
};

/// -o, --to, --no-draco, --no-clobber and --json for meshOutputOf.
void addMeshOutputOptions(po::options_description& options);

/// The report about a mesh that was written.
struct MeshOutputReport {
  std::string sentence;
  OrderedJson json;  ///< the members beside `output`, `kind` and `bytes`
};

/// The output that -o and --to name, checked as checkOutput does; `endings` are those that it may
/// have. Throws UsageError, also where --json and the file both want the standard output.
[[nodiscard]] Result<MeshOutput> meshOutputOf(const ParsedWords& parsed, const std::string& input,
                                              const std::string& endings = kWrittenEndings);

/// Writes the file whole or not at all, and reports it on the standard output: the sentence, or
/// with --json one object. Where the file is the standard output the sentence is a note.
[[nodiscard]] Status writeMeshOutput(const MeshOutput& output, std::span<const std::uint8_t> bytes,
                                     const MeshOutputReport& report, Console& console);
/// The report alone, about a file of so many bytes that is written.
void reportMeshOutput(const MeshOutput& output, std::uint64_t bytes, const MeshOutputReport& report,
                      Console& console);

/// [{name, association, components, type}] of the fields that a file of this kind holds; `Field` is
/// MeshField or ManifestField.
template <class Fields>
[[nodiscard]] OrderedJson writtenFieldsJson(const Fields& fields, const std::string& ending) {
  OrderedJson out = OrderedJson::array();
  for (const auto& field : fields)
    if (holdsFields(ending, field.association))
      out.push_back({{"name", field.name},
                     {"association", field.association},
                     {"components", field.components},
                     {"type", field.type}});
  return out;
}

}  // namespace qtet
