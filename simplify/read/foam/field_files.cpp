#include "simplify/read/foam/field_files.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "simplify/read/foam/foam_list.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/grid_parts.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kSymmTensor = 6;

/// A field as the class in its file's header says.
struct FieldKind {
  const char* association;
  std::uint32_t components;
  const char* key;  ///< of the entry that has its values
};

/// "volSymmTensorField", "volScalarField::Internal"; nullopt: no field of cells or points.
std::optional<FieldKind> kindOf(std::string_view name) {
  const bool isOfCells = name.starts_with("vol");
  if (!isOfCells && !name.starts_with("point")) return std::nullopt;
  FieldKind out{isOfCells ? "cell" : "point", 0, "internalField"};
  name.remove_prefix(isOfCells ? 3 : 5);
  if (const std::size_t part = name.find("::"); part != std::string_view::npos) {
    if (!name.ends_with("Internal") && !name.ends_with("InternalField")) return std::nullopt;
    out.key = "value";
    name = name.substr(0, part);
  }
  constexpr std::pair<std::string_view, std::uint32_t> kComponents[] = {
      {"ScalarField", 1},
      {"SphericalTensorField", 1},
      {"VectorField", 3},
      {"SymmTensorField", kSymmTensor},
      {"TensorField", 9}};
  for (const auto& [kind, components] : kComponents)
    if (name == kind) return out.components = components, out;
  return std::nullopt;
}

/// Copies that OpenFOAM and its users leave beside fields, and those with which a run restarts.
bool isCopy(std::string_view file) {
  constexpr std::string_view kEndings[] = {"~", "_0", "_0.gz", ".bak", ".BAK", ".old", ".save"};
  return std::ranges::any_of(kEndings,
                             [&](std::string_view ending) { return file.ends_with(ending); });
}

/// The files that may be fields by their names, "T" of T and of T.gz.
std::map<std::string, fs::path> filesIn(const fs::path& folder) {
  std::map<std::string, fs::path> out;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    const fs::path& file = entry.path();
    if (isCopy(file.filename().string()) || !entry.is_regular_file(code)) continue;
    if (file.extension() == ".gz")
      out.try_emplace(file.stem().string(), file);
    else
      out.insert_or_assign(file.filename().string(), file);
  }
  return out;
}

/// From xx xy xz yy yz zz to xx yy zz xy yz xz.
void reorderSymmetric(std::vector<double>& values) {
  constexpr std::array<std::size_t, kSymmTensor> kFrom{0, 3, 5, 1, 4, 2};
  std::array<double, kSymmTensor> tuple{};
  for (std::size_t i = 0; i < values.size(); i += kSymmTensor) {
    std::copy_n(&values[i], kSymmTensor, tuple.begin());
    for (std::size_t k = 0; k < kSymmTensor; ++k) values[i + k] = tuple[kFrom[k]];
  }
}

}  // namespace

Status addFoamFields(const fs::path& folder, const FieldNames& wanted,
                     std::chrono::seconds patience, std::uint64_t& room, CellMesh& mesh,
                     ReadReport& report) {
  FieldChoice choice(wanted, report);
  int number = 0;
  for (const auto& [called, path] : filesIn(folder)) {
    std::error_code code;
    if (fs::file_size(path, code) == 0 && !code) {
      report.notes.push_back(path.string() + " is empty (0 bytes), and was left out");
      continue;
    }
    const Result<std::string> className = FoamList::classOf(path);
    if (!className && path.extension() != ".gz") return std::unexpected(className.error());
    if (!className) {  // any program compresses files
      report.notes.push_back(className.error().message + "; it was left out");
      continue;
    }
    const std::optional<FieldKind> kind = kindOf(*className);
    if (!kind) continue;
    const auto name =
        choice.nameOf({called, number++, kind->components, true, false}, kind->association, mesh);
    if (!name) continue;
    Result<FoamList> file = FoamList::open(folder / called, patience);
    if (!file) return std::unexpected(file.error());
    MeshField field{*name, kind->components, file->realType(), {}, kind->association};
    const std::uint64_t count = isCellField(field) ? mesh.cells() : mesh.points.size();
    if (count > room / (kind->components * sizeof(double)))
      return badFile(path,
                     "the case's fields take more memory than the machine has to spare; choose "
                     "some with `fields`, and times with `time`");
    room -= count * kind->components * sizeof(double);
    auto values = file->field(kind->key, kind->components, count);
    if (!values) return std::unexpected(values.error());
    if (!*values) {
      report.notes.push_back(path.string() + " gives its " + kind->key +
                             " by a macro, and was left out; foamDictionary -expand writes values");
      continue;
    }
    field.values = std::move(**values);
    if (kind->components == kSymmTensor) reorderSymmetric(field.values);
    mesh.fields.push_back(std::move(field));
  }
  return {};
}

}  // namespace qtet
