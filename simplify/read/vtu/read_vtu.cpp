#include "simplify/read/vtu/read_vtu.h"

#include <algorithm>
#include <cassert>
#include <new>
#include <stdexcept>
#include <string_view>

#include "proto/limits.h"
#include "simplify/read/options/grid_parts.h"
#include "simplify/read/vtu/old_hexahedra.h"
#include "simplify/read/vtu/structured_cells.h"
#include "simplify/read/vtu/vtu_cells.h"
#include "simplify/read/vtu/vtu_numbers.h"
#include "simplify/split/higher_cells.h"

namespace qtet {
namespace {

bool isFloat(const VtuArray& array) {
  return array.type == VtuNumber::kFloat32 || array.type == VtuNumber::kFloat64;
}

/// The parts of a document that differ between fields of points and of cells.
struct Association {
  const char* name;
  const char* element;
  VtuFields VtuPiece::* fields;
  std::uint64_t VtuPiece::* tuples;
};
constexpr Association kPointSection{"point", "<PointData>", &VtuPiece::pointFields,
                                    &VtuPiece::points};
constexpr Association kCellSection{"cell", "<CellData>", &VtuPiece::cellFields, &VtuPiece::cells};

/// The array of one piece.
struct Part {
  const VtuArray* array;
  std::uint64_t tuples;
};

class VtuReader {
 public:
  VtuReader(const VtuFile& file, const VtuDocument& document, const FieldNames& wanted,
            ReadReport& report)
      : file_(file), document_(document), choice_(wanted, report), report_(report) {}

  Result<CellMesh> read() {
    std::uint64_t points = 0, cells = 0;
    for (const VtuPiece& piece : document_.pieces)
      if (__builtin_add_overflow(points, piece.points, &points) ||
          __builtin_add_overflow(cells, piece.cells, &cells) || (points | cells) >> 63 != 0)
        return file_.bad("its pieces have more than 2^63 points or cells; it is damaged");
    if (points + cells == 0) return CellMesh{};
    for (const auto step : {&VtuReader::readPoints, &VtuReader::readGlobalIds,
                            &VtuReader::readCells, &VtuReader::readFields})
      if (Status done = (this->*step)(); !done) return std::unexpected(done.error());
    if (document_.hasOldHexahedra) renumberOldHexahedra(out_);
    return std::move(out_);
  }

 private:
  Status readPoints() {
    if (document_.kind == GridKind::kRectilinear || document_.kind == GridKind::kImage) {
      out_.pointType = "float64";
      return addGridPoints(file_, document_, document_.pieces.front(), out_.points);
    }
    std::vector<Part> parts;
    for (const VtuPiece& piece : document_.pieces) {
      if (piece.points > 0 && !piece.coordinates)
        return file_.bad("line " + std::to_string(piece.line) +
                         ": a <Piece> has points, but not exactly one array in <Points>; the file "
                         "is damaged, export it again");
      if (!piece.coordinates) continue;
      if (piece.coordinates->components != 3)
        return file_.bad(piece.coordinates->called() + " has " +
                         std::to_string(piece.coordinates->components) +
                         " components, not 3; the file is damaged, export it again");
      parts.push_back({&*piece.coordinates, piece.points});
    }
    if (Status alike = areAlike(parts); !alike) return alike;
    out_.pointType =
        parts.empty() || parts.front().array->type == VtuNumber::kFloat32 ? "float32" : "float64";
    const auto certain = certainTuples(parts);
    if (!certain) return std::unexpected(certain.error());
    out_.points.reserve(*certain);
    Position p{};
    std::size_t k = 0;
    return readParts(parts, [&](std::span<const double> coordinates) {
      for (const double x : coordinates) {
        p[k++] = x;
        if (k < p.size()) continue;
        out_.points.push_back(p);
        k = 0;
      }
    });
  }

  /// The points' ids that hold for all pieces, if there are such integers.
  Status readGlobalIds() {
    const VtuFields& first = document_.pieces.front().pointFields;
    const auto find = [&](std::string_view name) -> const VtuArray* {
      const auto at = std::ranges::find(first.arrays, name, &VtuArray::name);
      return at == first.arrays.end() || bytesOf(at->type) == 0 ? nullptr : &*at;
    };
    const VtuArray* ids = first.globalIds.empty() ? nullptr : find(first.globalIds);
    if (ids && ids->components != 1) ids = nullptr;
    for (const char* name : kGlobalIdNames)
      if (!ids) ids = find(name);
    if (!ids || ids->components != 1 || (isFloat(*ids) && !ids->isIdType)) return {};
    const auto parts = partsOf(*ids, kPointSection);
    if (!parts) return std::unexpected(parts.error());
    out_.pointIds.reserve(out_.points.size());
    for (const Part& part : *parts) {
      const Status done = readIntegers(
          file_, document_, *part.array, {part.tuples, 0, part.tuples}, [&](auto numbers) {
            out_.pointIds.insert(out_.pointIds.end(), numbers.begin(), numbers.end());
          });
      if (!done) return done;
    }
    return {};
  }

  Status readCells() {
    if (document_.kind != GridKind::kUnstructured) {
      if (Status done =
              addGridCells(file_, document_, document_.pieces.front(), out_, rows_, report_);
          !done)
        return done;
      if (rows_.isPartial()) out_.cellIds = rows_.rows();
      return {};
    }
    std::uint64_t firstPoint = 0;
    for (const VtuPiece& piece : document_.pieces) {
      if (Status done = readVtuCells(file_, document_, piece, firstPoint, out_, rows_, report_);
          !done)
        return done;
      firstPoint += piece.points;
    }
    if (rows_.isPartial()) out_.cellIds = rows_.rows();
    return {};
  }

  Status readFields() {
    for (const Association& of : {kPointSection, kCellSection})
      if (Status done = readFieldsOf(of); !done) return done;
    return {};
  }

  /// All pieces have the first one's arrays, each once.
  Status readFieldsOf(const Association& of) {
    const VtuFields& fields = document_.pieces.front().*of.fields;
    int number = 0;
    for (const VtuArray& array : fields.arrays) {
      if (&array != &*std::ranges::find(fields.arrays, array.name, &VtuArray::name)) continue;
      const auto name =
          choice_.nameOf({array.name, number++, array.components, array.type != VtuNumber::kText,
                          isOfTheShape(fields, array)},
                         of.name, out_);
      if (!name) {
        if (Status sound = canBe(array, of); !sound) return sound;
        continue;
      }
      Result<MeshField> field = fieldOf(array, of);
      if (!field) return std::unexpected(field.error());
      field->name = *name;
      out_.fields.push_back(std::move(*field));
    }
    return {};
  }

  /// A field of too many components is not decoded, but a count that no file can hold is damage.
  [[nodiscard]] Status canBe(const VtuArray& array, const Association& of) const {
    if (array.components <= kMaxFieldComponents || bytesOf(array.type) == 0) return {};
    const auto parts = partsOf(array, of);
    if (!parts) return std::unexpected(parts.error());
    for (const Part& part : *parts) {
      const auto told = numbersOf(part);
      if (!told) return std::unexpected(told.error());
      const auto certain = certainNumbers(file_, document_, *part.array, *told);
      if (!certain) return std::unexpected(certain.error());
      if (part.array->place == VtuArray::Place::kAscii && *certain < *told)
        return file_.bad(part.array->called() + " has no room for the " + std::to_string(*told) +
                         " numbers that the file's counts say; it is damaged, export it again");
    }
    return {};
  }

  Result<MeshField> fieldOf(const VtuArray& array, const Association& of) {
    const auto parts = partsOf(array, of);
    if (!parts) return std::unexpected(parts.error());
    const auto certain = certainTuples(*parts);
    if (!certain) return std::unexpected(certain.error());
    MeshField field{{}, array.components, fieldTypeOf(array), {}, of.name};
    field.values.reserve(*certain * array.components);
    const Status done = readParts(*parts, [&](std::span<const double> values) {
      field.values.insert(field.values.end(), values.begin(), values.end());
    });
    if (!done) return std::unexpected(done.error());
    if (of.tuples == &VtuPiece::cells && rows_.isPartial()) keepRows(field, rows_.rows());
    return field;
  }

  /// The array of the first piece, and those of its name in the others.
  Result<std::vector<Part>> partsOf(const VtuArray& first, const Association& of) const {
    std::vector<Part> out;
    for (const VtuPiece& piece : document_.pieces) {
      const std::vector<VtuArray>& arrays = (piece.*of.fields).arrays;
      const auto at = std::ranges::find(arrays, first.name, &VtuArray::name);
      if (at != arrays.end()) {
        out.push_back({&*at, piece.*of.tuples});
      } else if (piece.*of.tuples > 0) {
        return file_.bad("line " + std::to_string(piece.line) + ": a <Piece> has no array " +
                         first.shortName() + " in " + of.element +
                         ", which the first piece has; export the mesh again");
      }
    }
    if (Status alike = areAlike(out); !alike) return std::unexpected(alike.error());
    return out;
  }

  /// Whether all parts with tuples have the type and the components of the first.
  [[nodiscard]] Status areAlike(std::span<const Part> parts) const {
    for (const Part& part : parts) {
      const VtuArray& first = *parts.front().array;
      if (part.tuples > 0 &&
          (part.array->type != first.type || part.array->components != first.components))
        return file_.bad(part.array->called() +
                         " has another type or number of components than in the first piece; "
                         "export the mesh again");
    }
    return {};
  }

  /// How many tuples may be reserved.
  [[nodiscard]] Result<std::uint64_t> certainTuples(std::span<const Part> parts) const {
    std::uint64_t out = 0;
    for (const Part& part : parts) {
      const auto told = numbersOf(part);
      if (!told) return std::unexpected(told.error());
      const auto certain = certainNumbers(file_, document_, *part.array, *told);
      if (!certain) return std::unexpected(certain.error());
      out += *certain / part.array->components;
    }
    return out;
  }

  [[nodiscard]] Result<std::uint64_t> numbersOf(const Part& part) const {
    std::uint64_t out = 0;
    if (__builtin_mul_overflow(part.tuples, std::uint64_t{part.array->components}, &out))
      return file_.bad(part.array->called() +
                       " would have more than 2^64 numbers; the file is damaged, export it again");
    return out;
  }

  Status readParts(std::span<const Part> parts, const TakeNumbers<double>& take) const {
    for (const Part& part : parts) {
      if (part.tuples == 0) continue;
      const auto told = numbersOf(part);
      if (!told) return std::unexpected(told.error());
      if (Status done = readReals(file_, document_, *part.array, {*told, 0, *told}, take); !done)
        return done;
    }
    return {};
  }

  const VtuFile& file_;
  const VtuDocument& document_;
  FieldChoice choice_;
  ReadReport& report_;
  CellMesh out_;
  KeptRows rows_;
};

}  // namespace

bool isOfTheShape(const VtuFields& fields, const VtuArray& array) {
  return (array.name == kDegreesField && fields.degrees == array.name && array.components == 3) ||
         (array.name == kWeightsField && fields.weights == array.name && array.components == 1);
}

std::string fieldTypeOf(const VtuArray& array) {
  if (array.isIdType) return "int64";
  switch (array.type) {
    case VtuNumber::kInt8: return "int8";
    case VtuNumber::kBit:
    case VtuNumber::kUInt8: return "uint8";
    case VtuNumber::kInt16: return "int16";
    case VtuNumber::kUInt16: return "uint16";
    case VtuNumber::kInt32: return "int32";
    case VtuNumber::kUInt32: return "uint32";
    case VtuNumber::kInt64: return "int64";
    case VtuNumber::kUInt64: return "uint64";
    case VtuNumber::kFloat32: return "float32";
    default: return "float64";
  }
}

Result<CellMesh> readVtu(const VtuFile& file, const VtuDocument& document, const FieldNames& fields,
                         ReadReport& report) {
  assert(document.kind == GridKind::kUnstructured || document.pieces.size() == 1);
  try {
    return VtuReader(file, document, fields, report).read();
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return file.bad(
      "an array's stated length does not fit in memory; the file is damaged, or the machine too "
      "small for it");
}

Result<std::optional<double>> readVtuTime(const VtuFile& file, const VtuDocument& document) {
  std::optional<double> time;
  if (!document.time || bytesOf(document.time->type) == 0) return time;
  const Status done =
      readReals(file, document, *document.time, {1, 0, 1}, [&](std::span<const double> numbers) {
        if (!numbers.empty()) time = numbers.front();
      });
  if (!done) return std::unexpected(done.error());
  return time;
}

}  // namespace qtet
