#include "simplify/produce/extracted_level.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "codec/files/mesh_file.h"
#include "proto/field_key.h"
#include "proto/level_error_json.h"
#include "simplify/log/kept_input.h"
#include "simplify/log/write_mesh.h"
#include "simplify/split/split_cells.h"

namespace qtet {
namespace {

std::string endingOfFiles(const MeshOutput& output) {
  return isCollection(output) ? ".vtu" : output.ending;
}

struct LatticeField {
  FieldInfo info;
  std::vector<std::int32_t> values;
};

std::vector<LatticeField> takeFields(LatticeMesh& mesh) {
  std::vector<LatticeField> out;
  for (std::size_t f = 0; f < mesh.fields.size(); ++f)
    out.push_back({std::move(mesh.fields[f]), std::move(mesh.values[f])});
  mesh.fields.clear(), mesh.values.clear();
  return out;
}

std::vector<MeshField> takeFields(TetMesh& mesh) { return std::exchange(mesh.fields, {}); }

void addField(LatticeMesh& mesh, LatticeField&& field, const std::string& name) {
  field.info.name = name;
  mesh.fields.push_back(std::move(field.info));
  mesh.values.push_back(std::move(field.values));
}

void addField(TetMesh& mesh, MeshField&& field, const std::string& name) {
  field.name = name;
  mesh.fields.push_back(std::move(field));
}

Result<Bytes> bytesOf(const LatticeMesh& mesh, const std::string& ending,
                      const MeshFileOptions& options) {
  return meshFileBytes(mesh, ending, options);
}

Result<Bytes> bytesOf(const TetMesh& mesh, const std::string& ending, const MeshFileOptions&) {
  return meshFileBytes(fileMesh(mesh), ending);
}

/// The fields of the log's levels. The last level also has those that its closing blocks hold.
std::vector<ManifestField> fieldsOf(const OpenedLog& log, bool restores) {
  std::vector<ManifestField> out = log.manifest.fields;
  if (!restores || !log.file.hasClosing(ClosingKind::kOriginalCells)) return out;
  out.emplace_back().name = kOriginalCellField;
  out.back().association = "cell";
  return out;
}

/// The numbers of the fields that are meant, ascending (field_key.h).
Result<std::vector<std::uint32_t>> wantedFields(
    const std::optional<std::vector<std::string>>& names,
    const std::vector<ManifestField>& fields) {
  std::vector<std::uint32_t> wanted(fields.size());
  std::iota(wanted.begin(), wanted.end(), 0u);
  if (!names) return wanted;
  wanted.clear();
  for (const std::string& name : *names) {
    const std::vector<std::uint32_t> meant = fieldsOfKey(fields, name);
    if (meant.empty())
      return fail(ErrorCode::kNotFound,
                  "the log has no field '" + name +
                      "' at this level; qtet info shows which it has, and what is kept for the "
                      "last level alone");
    wanted.insert(wanted.end(), meant.begin(), meant.end());
  }
  std::ranges::sort(wanted);
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  return wanted;
}

/// Makes the mesh with each file's fields; `numbers` are those of its own fields, ascending.
template <class Mesh>
Status makeFiles(Mesh& mesh, const std::vector<std::uint32_t>& numbers,
                 const std::vector<InstantFile>& files, const MeshOutput& output,
                 const FileTaker& take) {
  auto all = takeFields(mesh);
  for (const InstantFile& file : files) {
    const bool isLast = &file == &files.back();
    takeFields(mesh);
    for (const FieldInFile& field : file.fields) {
      const auto at = std::ranges::lower_bound(numbers, field.number) - numbers.begin();
      auto& own = all[static_cast<std::size_t>(at)];
      addField(mesh, field.isInstant || isLast ? std::move(own) : auto(own), field.name);
    }
    Result<Bytes> bytes = bytesOf(mesh, endingOfFiles(output), output.options);
    if (!bytes) return std::unexpected(bytes.error());
    if (Status s = take(file, std::move(*bytes)); !s) return s;
  }
  return {};
}

/// At the last level the files are the input itself, as far as the log kept it.
Status makeInput(const OpenedLog& log, const LatticeMesh& finest,
                 const std::vector<InstantFile>& files, const MeshOutput& output,
                 const FileTaker& take) {
  Result<RestoredInput> input = restoreInput(log.file, finest);
  if (!input) return std::unexpected(input.error());
  const bool exact = input->exactPositions ||
                     std::ranges::find(input->exactFields, true) != input->exactFields.end();
  const bool asRead = exact && !needsLattice(output.ending);
  std::vector<std::uint32_t> numbers(asRead ? input->mesh.fields.size()
                                            : input->lattice.fields.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  return asRead ? makeFiles(input->mesh, numbers, files, output, take)
                : makeFiles(input->lattice, numbers, files, output, take);
}

/// `known`: the fields that the numbers of `wanted` mean, those of the manifest first. Those of an
/// instant are called as in its file.
MeshOutputReport reportOf(const Manifest& manifest, std::uint32_t level,
                          const std::vector<ManifestField>& known,
                          const std::vector<FieldInFile>& wanted, const std::string& ending) {
  const ManifestLevel& told = manifest.levels[level];
  const std::size_t last = manifest.levels.size() - 1;
  MeshOutputReport out{"level " + std::to_string(level) + " of " + std::to_string(last) + ", " +
                           counted(told.tetrahedra, "tetrahedron", "tetrahedra") + ", " +
                           counted(told.vertices, "point", "points"),
                       {{"level", level},
                        {"levels", last},
                        {"tetrahedra", told.tetrahedra},
                        {"vertices", told.vertices},
                        {"boundaryTriangles", told.boundaryTriangles}}};
  std::vector<ManifestField> fields;
  LevelError error = told.error.value_or(LevelError());
  error.fields.clear();
  std::vector<bool> isLabel;
  for (const auto& [f, name, isInstant] : wanted) {
    if (!holdsFields(ending, known[f].association)) continue;
    fields.push_back(known[f]);
    fields.back().name = name;
    if (!told.error || f >= told.error->fields.size()) continue;
    error.fields.push_back(told.error->fields[f]);
    isLabel.push_back(labelNamesOf(manifest, f) != nullptr);
  }
  out.json["fields"] = writtenFieldsJson(fields, ending);
  if (told.error) out.json["error"] = toJson(error, isLabel);
  return out;
}

}  // namespace

bool isCollection(const MeshOutput& output) { return output.ending == kCollection; }

Result<MeshOutputReport> extractLevel(const OpenedLog& log, const Result<std::uint32_t>& level,
                                      const LevelFiles& asked) {
  if (!level) return std::unexpected(level.error());
  const bool restores =
      *level + 1 == log.manifest.levels.size() && !log.file.closingBlocks().empty();
  const std::vector<ManifestField> known = fieldsOf(log, restores);
  const Result<std::vector<std::uint32_t>> wanted = wantedFields(asked.fields, known);
  if (!wanted) return std::unexpected(wanted.error());
  const auto files = asked.choose(known, *wanted);
  if (!files) return std::unexpected(files.error());
  std::vector<std::uint32_t> decoded;
  for (const InstantFile& file : *files)
    for (const FieldInFile& field : file.fields) decoded.push_back(field.number);
  std::ranges::sort(decoded);
  decoded.erase(std::unique(decoded.begin(), decoded.end()), decoded.end());
  Result<LatticeMesh> mesh =
      meshAtLevel(log.file, *level, restores ? std::nullopt : std::optional(decoded));
  if (!mesh) return std::unexpected(mesh.error());
  if (Status s = restores ? makeInput(log, *mesh, *files, asked.output, asked.take)
                          : makeFiles(*mesh, decoded, *files, asked.output, asked.take);
      !s)
    return std::unexpected(s.error());
  return reportOf(log.manifest, *level, known, files->front().fields, endingOfFiles(asked.output));
}

}  // namespace qtet
