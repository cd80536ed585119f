#include "simplify/read_mesh.h"

#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkGenericCell.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "proto/limits.h"
#include "simplify/vtk_grid.h"

namespace qtet {
namespace {

constexpr double kFirstInexactInteger = 9007199254740992.0;  // 2^53

std::unexpected<Error> bad(const std::filesystem::path& path, const std::string& what) {
  return fail(ErrorCode::kBadInput, path.string() + ": " + what);
}

Result<std::vector<Position>> pointsOf(vtkUnstructuredGrid& grid, const std::filesystem::path& path) {
  const vtkIdType count = grid.GetNumberOfPoints();
  if (count == 0) return bad(path, "it holds no points; export the volume mesh, not an empty selection");
  if (count > vtkIdType{kMaxElements}) {
    return fail(ErrorCode::kLimitExceeded,
                path.string() + ": " + std::to_string(count) + " points; at most " + std::to_string(kMaxElements) + " are allowed");
  }
  std::vector<Position> points(static_cast<std::size_t>(count));
  std::uint64_t notFinite = 0;
  vtkIdType first = -1;
  for (vtkIdType i = 0; i < count; ++i) {
    Position& p = points[static_cast<std::size_t>(i)];
    grid.GetPoint(i, p.data());
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
    if (notFinite++ == 0) first = i;
  }
  if (notFinite > 0) {
    return bad(path, std::to_string(notFinite) + " points have a coordinate that is NaN or infinite, the first is point " +
                         std::to_string(first) + "; remove these points and their cells before exporting");
  }
  return points;
}

struct CellKind {
  bool known = false;
  int dimension = 0;
  std::string name;
};

CellKind kindOf(int type) {
  const vtkSmartPointer<vtkCell> cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
  if (!cell) return {false, 0, "unknown"};
  return {true, type == VTK_EMPTY_CELL ? 0 : cell->GetCellDimension(), vtkCellTypes::GetClassNameFromTypeId(type)};
}

/// The cells' vertex ids by offsets; VTK hands them on as the file has them, unchecked.
class CellVertices {
 public:
  explicit CellVertices(vtkCellArray& cells) : offsets_(cells.GetOffsetsArray()), ids_(cells.GetConnectivityArray()) {}

  /// Whether the four vertices of cell `i` are there and below `points`; then they are in `out`.
  [[nodiscard]] bool tetrahedron(vtkIdType i, vtkIdType points, Tetrahedron& out) const {
    if (i + 1 >= offsets_->GetNumberOfTuples()) return false;
    const auto begin = static_cast<vtkIdType>(offsets_->GetComponent(i, 0));
    const auto end = static_cast<vtkIdType>(offsets_->GetComponent(i + 1, 0));
    if (begin < 0 || end - begin != 4 || end > ids_->GetNumberOfTuples()) return false;
    for (int k = 0; k < 4; ++k) {
      const double id = ids_->GetComponent(begin + k, 0);
      if (!(id >= 0 && id < static_cast<double>(points))) return false;
      out[static_cast<std::size_t>(k)] = static_cast<VertexId>(id);
    }
    return true;
  }

 private:
  vtkDataArray* offsets_;
  vtkDataArray* ids_;
};

struct Tetrahedra {
  std::vector<Tetrahedron> cells;
  std::vector<vtkIdType> rows;  ///< where each of them stands among the file's cells
};

Result<Tetrahedra> tetrahedraOf(vtkUnstructuredGrid& grid, const std::filesystem::path& path, ReadReport& report) {
  const vtkIdType count = grid.GetNumberOfCells();
  vtkUnsignedCharArray* types = grid.GetCellTypesArray();
  if (count == 0 || !types || !grid.GetCells()) return bad(path, "it holds no cells; export the volume mesh, not only its points");
  if (types->GetNumberOfTuples() < count) return bad(path, "fewer cell types than cells; the file is damaged, export it again");

  const CellVertices vertices(*grid.GetCells());
  Tetrahedra out;
  for (vtkIdType i = 0; i < count; ++i) {
    const int type = types->GetValue(i);
    if (type == VTK_TETRA) {
      Tetrahedron cell{};
      if (!vertices.tetrahedron(i, grid.GetNumberOfPoints(), cell)) {
        return bad(path, "cell " + std::to_string(i) + " is a tetrahedron without four vertices among the " +
                             std::to_string(grid.GetNumberOfPoints()) + " points; the file is damaged, export it again");
      }
      out.cells.push_back(cell);
      out.rows.push_back(i);
      continue;
    }
    const CellKind kind = kindOf(type);
    if (!kind.known || kind.dimension >= 3) {
      return bad(path,
                 "cell " + std::to_string(i) + " is of VTK type " + std::to_string(type) + " (" + kind.name +
                     "), only linear tetrahedra (type 10) are simplified; split the cells first (in ParaView: filter Tetrahedralize)");
    }
    ++report.ignoredCells;
  }
  if (out.cells.empty())
    return bad(path, "none of its " + std::to_string(count) + " cells is a tetrahedron; export the volume mesh, not its surface");
  if (out.cells.size() > kMaxElements) {
    return fail(ErrorCode::kLimitExceeded, path.string() + ": " + std::to_string(out.cells.size()) + " tetrahedra; at most " +
                                               std::to_string(kMaxElements) + " are allowed");
  }
  if (report.ignoredCells > 0)
    report.notes.push_back(std::to_string(report.ignoredCells) + " points, lines and faces among the cells were ignored");
  return out;
}

/// The type's name, or an empty text for texts and the like.
std::string typeName(vtkDataArray& array) {
  if (array.GetDataType() == VTK_FLOAT) return "float32";
  if (array.GetDataType() == VTK_DOUBLE) return "float64";
  if (array.GetDataType() == VTK_BIT) return "uint8";
  const bool isSigned = array.GetDataTypeMin() < 0;
  return (isSigned ? "int" : "uint") + std::to_string(8 * array.GetDataTypeSize());
}

/// An array of the file that can be a field, with the name that it gets.
struct Candidate {
  std::string association;  ///< point or cell
  std::string name;
  vtkDataArray* array;

  /// `asked` is the name, or the name behind "point:" or "cell:".
  [[nodiscard]] bool isMeantBy(const std::string& asked) const { return asked == name || asked == association + ":" + name; }
};

/// The field of `rows` (the array's tuples, in the mesh's order); `tuples` is what the array must have.
Result<MeshField> fieldOf(const Candidate& candidate, const std::vector<vtkIdType>& rows, vtkIdType tuples,
                          const std::filesystem::path& path) {
  vtkDataArray& array = *candidate.array;
  if (array.GetNumberOfTuples() != tuples) {
    return bad(path, candidate.association + " field " + candidate.name + " has " + std::to_string(array.GetNumberOfTuples()) +
                         " tuples for " + std::to_string(tuples) + " " + candidate.association + "s; export it again");
  }
  MeshField field{candidate.name, static_cast<std::uint32_t>(array.GetNumberOfComponents()), typeName(array), {}, candidate.association};
  const bool wide = field.type == "int64" || field.type == "uint64";
  field.values.resize(rows.size() * field.components);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double* tuple = field.values.data() + i * field.components;
    array.GetTuple(rows[i], tuple);
    for (std::uint32_t c = 0; wide && c < field.components; ++c) {
      if (std::abs(tuple[c]) < kFirstInexactInteger) continue;
      return bad(path, candidate.association + " field " + candidate.name + " holds an integer of 2^53 or more at " +
                           candidate.association + " " + std::to_string(i) +
                           "; leave the field out with --fields, or store it in fewer bits");
    }
  }
  return field;
}

/// Whether `text` is UTF-8 as far as its leading and continuing bytes go.
bool isUtf8(const std::string& text) {
  int pending = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continues = (byte & 0xC0) == 0x80;
    if (continues != (pending > 0) || byte >= 0xF8) return false;
    if (continues)
      --pending;
    else if (byte >= 0xC0)
      pending = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : 1;
  }
  return pending == 0;
}

/// The array's name, or "unnamed-I" where the manifest could not hold it.
std::string nameOf(vtkAbstractArray& array, const std::string& association, int number, ReadReport& report) {
  const std::string name = array.GetName() ? array.GetName() : "";
  if (!name.empty() && name.size() <= kMaxNameBytes && isUtf8(name)) return name;
  const std::string substitute = "unnamed-" + std::to_string(number);
  report.notes.push_back(association + " field number " + std::to_string(number) + " has no name, or none of at most " +
                         std::to_string(kMaxNameBytes) + " bytes of UTF-8, and is called " + substitute);
  return substitute;
}

void addCandidates(vtkFieldData& data, const std::string& association, ReadReport& report, std::vector<Candidate>& out) {
  for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
    vtkAbstractArray* any = data.GetAbstractArray(i);
    const std::string name = nameOf(*any, association, i, report);
    vtkDataArray* array = data.GetArray(i);
    const bool fits =
        array && array->GetNumberOfComponents() >= 1 && array->GetNumberOfComponents() <= static_cast<int>(kMaxFieldComponents);
    if (fits) {
      out.push_back({association, name, array});
      continue;
    }
    report.ignoredFields.push_back(name);
    report.notes.push_back(
        association + " field " + name + " was ignored: " +
        (array ? "more than " + std::to_string(kMaxFieldComponents) + " components" : std::string("it holds no numbers")));
  }
}

std::string namesOf(const std::vector<Candidate>& candidates) {
  std::string out;
  for (const Candidate& candidate : candidates) out += (out.empty() ? "" : ", ") + candidate.name;
  return out.empty() ? "none" : out;
}

/// The candidates that were asked for, in the order asked, each once.
Result<std::vector<Candidate>> chosen(std::vector<Candidate> candidates, const FieldNames& names, const std::filesystem::path& path) {
  if (!names) return candidates;
  std::vector<Candidate> out;
  for (const std::string& name : *names) {
    bool found = false;
    for (const Candidate& candidate : candidates) {
      if (!candidate.isMeantBy(name)) continue;
      found = true;
      if (std::ranges::find(out, candidate.array, &Candidate::array) == out.end()) out.push_back(candidate);
    }
    if (!found) return fail(ErrorCode::kNotFound, path.string() + " has no field '" + name + "'; it has: " + namesOf(candidates));
  }
  return out;
}

Result<std::vector<MeshField>> fieldsOf(vtkUnstructuredGrid& grid, const std::vector<vtkIdType>& tetrahedronRows, const FieldNames& names,
                                        const std::filesystem::path& path, ReadReport& report) {
  std::vector<Candidate> all;
  addCandidates(*grid.GetPointData(), "point", report, all);
  addCandidates(*grid.GetCellData(), "cell", report, all);
  Result<std::vector<Candidate>> candidates = chosen(std::move(all), names, path);
  if (!candidates) return std::unexpected(candidates.error());
  if (candidates->size() > kMaxFields) {
    return fail(ErrorCode::kLimitExceeded, path.string() + ": " + std::to_string(candidates->size()) + " fields; choose at most " +
                                               std::to_string(kMaxFields) + " with --fields");
  }
  std::vector<vtkIdType> pointRows(static_cast<std::size_t>(grid.GetNumberOfPoints()));
  std::iota(pointRows.begin(), pointRows.end(), vtkIdType{0});
  std::vector<MeshField> fields;
  for (const Candidate& candidate : *candidates) {
    Result<MeshField> field = candidate.association == "point" ? fieldOf(candidate, pointRows, grid.GetNumberOfPoints(), path)
                                                               : fieldOf(candidate, tetrahedronRows, grid.GetNumberOfCells(), path);
    if (!field) return std::unexpected(field.error());
    fields.push_back(std::move(*field));
  }
  return fields;
}

}  // namespace

Result<ReadMesh> readMesh(const std::filesystem::path& path, const FieldNames& fields) {
  ReadMesh out;
  const auto grid = readVtkGrid(path, out.report.notes);
  if (!grid) return std::unexpected(grid.error());
  auto points = pointsOf(**grid, path);
  if (!points) return std::unexpected(points.error());
  auto tetrahedra = tetrahedraOf(**grid, path, out.report);
  if (!tetrahedra) return std::unexpected(tetrahedra.error());
  auto meshFields = fieldsOf(**grid, tetrahedra->rows, fields, path, out.report);
  if (!meshFields) return std::unexpected(meshFields.error());

  out.mesh = TetMesh{std::move(*points), std::move(tetrahedra->cells), std::move(*meshFields), (*grid)->GetPoints()->GetDataType() == VTK_FLOAT ? "float32" : "float64"};
  return out;
}

}  // namespace qtet
