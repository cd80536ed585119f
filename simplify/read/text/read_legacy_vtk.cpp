#include <algorithm>
#include <charconv>
#include <cstdint>
#include <span>
#include <tuple>

#include "simplify/read/options/grid_parts.h"
#include "simplify/read/text/legacy_numbers.h"
#include "simplify/read/text/mesh_scanner.h"
#include "simplify/read/text/text_readers.h"
#include "simplify/read/vtu/old_hexahedra.h"

namespace qtet {
namespace {

/// From this version on, cells have offsets; before, each cell's vertices follow their number.
constexpr int kOffsetsVersion = 5;

/// Names of arrays have blanks and the like as %20.
std::string decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    if (text[i] == '%' && text.size() - i > 2 &&
        std::from_chars(&text[i + 1], &text[i + 1] + 2, code, 16).ptr == &text[i + 1] + 2) {
      out += static_cast<char>(code);
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

struct Values {
  std::string name;
  std::uint64_t components = 1, tuples = 0;
  const LegacyType* type = nullptr;
  std::vector<double> numbers;
};

/// The arrays of POINT_DATA or CELL_DATA.
struct Data {
  std::uint64_t tuples = 0;
  std::vector<Values> fields;
};

class LegacyVtk {
 public:
  LegacyVtk(std::string_view text, const std::filesystem::path& path, const FieldNames& fields,
            ReadReport& report)
      : in_(text, path), path_(path), choice_(fields, report), report_(report) {}

  Result<std::optional<CellMesh>> read(std::chrono::seconds patience) {
    in_.giveUpAfter(patience);
    readHeader();
    while (isUnderstood_ && !in_.atEnd()) readPart(lowered(in_.word()));
    if (in_.failed()) return in_.error();
    if (!isUnderstood_) return std::nullopt;
    if (Status done = makeMesh(); !done) return std::unexpected(done.error());
    return std::move(out_);
  }

 private:
  void readHeader() {
    const std::string_view first = in_.line();  // # vtk DataFile Version 5.1
    const std::string_view version = first.substr(std::min(first.size(), first.rfind(' ') + 1));
    std::from_chars(version.data(), version.data() + version.size(), version_);
    hasOldHexahedra_ = isOlderVersion(version, kNewLegacyHexahedra);
    in_.skipLine();  // the title
    const std::string form = lowered(in_.word());
    bytes_ = form == "binary";
    isUnderstood_ = (bytes_ || form == "ascii") && lowered(in_.word()) == "dataset" &&
                    lowered(in_.word()) == "unstructured_grid";
  }

  void readPart(const std::string& word) {
    if (word == "points") {
      const auto count = in_.number<std::uint64_t>("the number of points");
      points_ = values("points", 3, count, typeOf(in_.word()));
    } else if (word == "cells") {
      readCells();
    } else if (word == "cell_types") {
      const auto count = in_.number<std::uint64_t>("the number of cell types");
      types_ = legacyIntegers(in_, bytes_, {count, VtuNumber::kInt32, "cell types"});
    } else if (word == "point_data") {
      pointData_.tuples = in_.number<std::uint64_t>("the number of points");
      data_ = &pointData_;
    } else if (word == "cell_data") {
      cellData_.tuples = in_.number<std::uint64_t>("the number of cells");
      data_ = &cellData_;
    } else if (word == "field") {
      readField();
    } else if (word == "metadata") {
      skipMetadata();
    } else if (data_ && word == "scalars") {
      readScalars();
    } else if (data_ && (word == "vectors" || word == "normals")) {
      readAttribute(3);
    } else if (data_ && word == "tensors") {
      readAttribute(9);
    } else {
      isUnderstood_ = false;
    }
  }

  /// Null for bits, texts and unknown words, which are left to VTK.
  const LegacyType* typeOf(std::string_view word) {
    const LegacyType* type = legacyType(word);
    isUnderstood_ = isUnderstood_ && type;
    return type;
  }

  void readCells() {
    const auto first = in_.number<std::uint64_t>("the number of cells"),
               second = in_.number<std::uint64_t>("the length of their list");
    if (version_ < kOffsetsVersion) {
      cellCount_ = first;
      list_ = legacyIntegers(in_, bytes_, {second, VtuNumber::kInt32, "numbers of cells"});
      return;
    }
    cellCount_ = first > 0 ? first - 1 : 0;
    for (const auto& [word, count, into] :
         {std::tuple("offsets", first, &offsets_), std::tuple("connectivity", second, &list_)}) {
      if (lowered(in_.word()) != word && !in_.failed())
        return in_.fail(ErrorCode::kBadInput,
                        std::string("the cells have no ") + word + "; export the file again");
      const LegacyType* type = typeOf(in_.word());
      if (type) *into = legacyIntegers(in_, bytes_, {count, type->number, word});
    }
  }

  /// FIELD NAME COUNT, and as many arrays. Before point and cell data they are of the whole file.
  void readField() {
    in_.word();
    const auto count = in_.number<std::uint64_t>("the number of arrays");
    for (std::uint64_t i = 0; i < count && isUnderstood_ && !in_.failed();) {
      std::string name(in_.word());
      if (name == "METADATA") {
        skipMetadata();
        continue;
      }
      const auto components = in_.number<std::uint64_t>("the number of components"),
                 tuples = in_.number<std::uint64_t>("the number of tuples");
      Values found = values(decoded(name), components, tuples, typeOf(in_.word()));
      if (data_) add(std::move(found));
      ++i;
    }
  }

  void readScalars() {
    const std::string name = decoded(in_.word());
    const LegacyType* type = typeOf(in_.word());
    const std::string_view rest = in_.line();
    std::uint64_t components = 1;
    if (!rest.empty()) std::from_chars(rest.data(), rest.data() + rest.size(), components);
    if (lowered(in_.word()) != "lookup_table" && !in_.failed())
      return in_.fail(ErrorCode::kBadInput,
                      "the scalars " + name + " have no line LOOKUP_TABLE; export the file again");
    in_.word();
    add(values(name, components, data_->tuples, type));
  }

  void readAttribute(std::uint64_t components) {
    const std::string name = decoded(in_.word());
    add(values(name, components, data_->tuples, typeOf(in_.word())));
  }

  /// VTK takes the last of arrays that have the same name, in the place of the first.
  void add(Values&& array) {
    auto& fields = data_->fields;
    isUnderstood_ =
        isUnderstood_ && std::ranges::find(fields, array.name, &Values::name) == fields.end();
    fields.push_back(std::move(array));
  }

  /// Lines up to an empty one.
  void skipMetadata() {
    in_.skipLine();
    while (!in_.failed() && in_.remaining() > 0 && !in_.line().empty()) {
    }
  }

  Values values(std::string name, std::uint64_t components, std::uint64_t tuples,
                const LegacyType* type) {
    Values out{std::move(name), components, tuples, type, {}};
    std::uint64_t count = 0;
    if (!type || in_.failed()) return out;
    if (__builtin_mul_overflow(components, tuples, &count)) count = ~std::uint64_t{0};
    out.numbers = legacyReals(in_, bytes_, {count, type->number, "numbers"});
    return out;
  }

  Status makeMesh() {
    if (points_.components != 3 || !points_.type) return bad("it has no POINTS; export it again");
    if (types_.size() != cellCount_)
      return bad("it has " + std::to_string(cellCount_) + " cells and " +
                 std::to_string(types_.size()) + " cell types; export it again");
    CellMesh mesh;
    mesh.pointType = points_.type->number == VtuNumber::kFloat32 ? "float32" : "float64";
    mesh.points.resize(points_.tuples);
    for (std::size_t i = 0; i < points_.numbers.size(); ++i)
      mesh.points[i / 3][i % 3] = points_.numbers[i];
    takePointIds(mesh);
    std::vector<std::uint64_t> rows;
    if (Status done = makeCells(mesh, rows); !done || !isUnderstood_) return done;
    if (rows.size() != cellCount_) mesh.cellIds = rows;
    for (const bool ofCells : {false, true})
      if (Status done = addFields(ofCells, rows, mesh); !done) return done;
    if (hasOldHexahedra_) renumberOldHexahedra(mesh);
    out_ = std::move(mesh);
    return {};
  }

  void takePointIds(CellMesh& mesh) const {
    for (const char* name : kGlobalIdNames) {
      const auto at = std::ranges::find(pointData_.fields, name, &Values::name);
      if (at == pointData_.fields.end()) continue;
      if (at->type->isFloat() || at->components != 1 || at->tuples != mesh.points.size()) return;
      for (const double id : at->numbers)
        mesh.pointIds.push_back(static_cast<std::uint64_t>(static_cast<std::int64_t>(id)));
      return;
    }
  }

  Status makeCells(CellMesh& mesh, std::vector<std::uint64_t>& rows) {
    std::size_t at = 0;
    for (std::uint64_t cell = 0; cell < cellCount_; ++cell) {
      std::size_t end = 0;
      if (version_ < kOffsetsVersion) {
        const std::int64_t count = at < list_.size() ? list_[at++] : -1;
        if (count < 0 || static_cast<std::uint64_t>(count) > list_.size() - at)
          return bad(verticesOutside(cell));
        end = at + static_cast<std::size_t>(count);
      } else {
        const std::int64_t from = offsets_[cell], to = offsets_[cell + 1];
        if (from < 0 || to < from || static_cast<std::uint64_t>(to) > list_.size())
          return bad(verticesOutside(cell));
        at = static_cast<std::size_t>(from);
        end = static_cast<std::size_t>(to);
      }
      const auto type = static_cast<std::uint8_t>(types_[cell]);
      if (type == kPolyhedronCell) isUnderstood_ = false;  // VTK's own way to write their faces
      if (dimensionOf(type) < 3) {
        ++report_.ignoredCells;
      } else if (!isHidden(cell)) {
        for (std::size_t k = at; k < end; ++k) mesh.vertices.push_back(narrowedId(list_[k]));
        mesh.types.push_back(type);
        mesh.begins.push_back(mesh.vertices.size());
        rows.push_back(cell);
      }
      at = end;
    }
    return {};
  }

  /// Whether the cell is another piece's, or blanked out.
  [[nodiscard]] bool isHidden(std::uint64_t cell) const {
    for (const Values& field : cellData_.fields) {
      if (field.tuples < cellCount_ || field.components == 0) continue;
      const double value = field.numbers[cell * field.components];
      if (field.name == kGhostLevels && value > 0) return true;
      if (field.name == kGhostTypes && field.type->number == VtuNumber::kUInt8 &&
          (static_cast<unsigned>(value) & kElsewhere) != 0)
        return true;
    }
    return false;
  }

  Status addFields(bool ofCells, std::span<const std::uint64_t> rows, CellMesh& mesh) {
    const std::string association = ofCells ? "cell" : "point";
    const std::uint64_t tuples = ofCells ? cellCount_ : points_.tuples;
    int number = 0;
    for (Values& found : (ofCells ? cellData_ : pointData_).fields) {
      const auto name =
          choice_.nameOf({found.name, number++, found.components, true, false}, association, mesh);
      if (!name) continue;
      if (found.tuples != tuples)
        return bad(association + " field " + *name + " has " + std::to_string(found.tuples) +
                   " tuples for " + std::to_string(tuples) + " " + association +
                   "s; export it again");
      MeshField field{*name, static_cast<std::uint32_t>(found.components), found.type->name,
                      std::move(found.numbers), association};
      if (ofCells && rows.size() != tuples) keepRows(field, rows);
      mesh.fields.push_back(std::move(field));
    }
    return {};
  }

  [[nodiscard]] Status bad(const std::string& what) const {
    return fail(ErrorCode::kBadInput, path_.string() + ": " + what);
  }

  MeshScanner in_;
  const std::filesystem::path& path_;
  FieldChoice choice_;
  ReadReport& report_;
  int version_ = 0;
  bool hasOldHexahedra_ = false;
  bool bytes_ = false;
  bool isUnderstood_ = true;
  Values points_;
  std::uint64_t cellCount_ = 0;
  std::vector<std::int64_t> offsets_, list_, types_;
  Data pointData_, cellData_;
  Data* data_ = nullptr;  ///< that arrays belong to now
  std::optional<CellMesh> out_;
};

}  // namespace

Result<std::optional<CellMesh>> readLegacyVtk(const std::filesystem::path& path,
                                              const FieldNames& fields, ReadReport& report,
                                              std::chrono::seconds patience) {
  const Result<std::string> text = wholeFile(path);
  if (!text) return std::unexpected(text.error());
  return LegacyVtk(*text, path, fields, report).read(patience);
}

}  // namespace qtet
