#include "simplify/read/vtk/vtk_cells.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "codec/coding/float_bits.h"
#include "proto/limits.h"
#include "simplify/read/options/select_fields.h"
#include "simplify/split/higher_cells.h"

namespace qtet {
namespace {

std::unexpected<Error> bad(const std::filesystem::path& path, const std::string& what) {
  return fail(ErrorCode::kBadInput, path.string() + ": " + what);
}

std::uint32_t narrowed(vtkIdType id) {
  return id >= 0 && id < vtkIdType{kGhost} ? static_cast<VertexId>(id) : kGhost;
}

template <class T>
double asDouble(T value) {
  if constexpr (std::is_same_v<T, float>)
    return widened(value);
  else
    return static_cast<double>(value);
}

/// All tuples as doubles; `out` has room for them. Without a virtual call a value where the array
/// is a plain one.
void copyValues(vtkDataArray& array, double* out) {
  const vtkIdType tuples = array.GetNumberOfTuples();
  const auto copyFrom = [&]<class T>(vtkAOSDataArrayTemplate<T>& plain) {
    const T* values = plain.GetPointer(0);
    std::transform(values, values + plain.GetNumberOfValues(), out,
                   [](T value) { return asDouble(value); });
  };
  switch (array.GetDataType()) {
    vtkTemplateMacro(if (auto* plain = vtkAOSDataArrayTemplate<VTK_TT>::FastDownCast(
                             &array)) return copyFrom(*plain));
    default: break;
  }
  for (vtkIdType i = 0; i < tuples; ++i) array.GetTuple(i, out + i * array.GetNumberOfComponents());
}

std::vector<Position> pointsOf(vtkDataSet& data) {
  const auto count = static_cast<std::size_t>(std::max<vtkIdType>(0, data.GetNumberOfPoints()));
  std::vector<Position> points(count);
  auto* set = vtkPointSet::SafeDownCast(&data);
  if (set && set->GetPoints() && !points.empty()) {
    copyValues(*set->GetPoints()->GetData(), points[0].data());
  } else {
    for (std::size_t i = 0; i < points.size(); ++i)
      data.GetPoint(static_cast<vtkIdType>(i), points[i].data());
  }
  return points;
}

/// The dimension of VTK's types of cells; unknown types count as volumes, so that checkCellMesh
/// refuses them by name.
class Dimensions {
 public:
  Dimensions() {
    for (int type = 0; type < 256; ++type) {
      const auto cell = type == VTK_EMPTY_CELL
                            ? nullptr
                            : vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
      of_[static_cast<std::size_t>(type)] = cell                     ? cell->GetCellDimension()
                                            : type == VTK_EMPTY_CELL ? 0
                                                                     : 3;
    }
  }
  [[nodiscard]] int operator[](int type) const {
    return of_[static_cast<std::size_t>(type & 0xFF)];
  }

 private:
  std::array<int, 256> of_{};
};

/// The marks of ghost cells in files of VTK before version 7: how many layers away they lie.
constexpr const char* kGhostLevels = "vtkGhostLevels";

/// Cells that are another piece's, or blanked out.
class Hidden {
 public:
  explicit Hidden(vtkDataSet& data)
      : ghosts_(data.GetCellGhostArray()), grid_(vtkStructuredGrid::SafeDownCast(&data)) {
    if (ghosts_ && ghosts_->GetNumberOfTuples() < data.GetNumberOfCells()) ghosts_ = nullptr;
    levels_ = data.GetCellData()->GetArray(kGhostLevels);
    if (levels_ && levels_->GetNumberOfTuples() < data.GetNumberOfCells()) levels_ = nullptr;
  }
  [[nodiscard]] bool operator[](vtkIdType cell) const {
    constexpr unsigned kElsewhere =
        vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    if (ghosts_ && (ghosts_->GetValue(cell) & kElsewhere)) return true;
    if (levels_ && levels_->GetComponent(cell, 0) > 0) return true;
    return grid_ && !grid_->IsCellVisible(cell);
  }

 private:
  vtkUnsignedCharArray* ghosts_;
  vtkDataArray* levels_;
  vtkStructuredGrid* grid_;
};

/// The points' ids that hold for all pieces; empty without an array of such integers.
std::vector<std::uint64_t> globalIdsOf(vtkDataSet& data) {
  vtkPointData& fields = *data.GetPointData();
  vtkDataArray* ids = fields.GetGlobalIds();
  for (const char* name : {"GlobalPointIds", "GlobalNodeIds", "GlobalNodeId"})
    if (!ids) ids = fields.GetArray(name);
  const vtkIdType points = data.GetNumberOfPoints();
  if (!ids || ids->GetNumberOfComponents() != 1 || ids->GetNumberOfTuples() != points ||
      ids->GetDataType() == VTK_FLOAT || ids->GetDataType() == VTK_DOUBLE)
    return {};
  std::vector<std::uint64_t> out;
  out.reserve(static_cast<std::size_t>(points));
  for (vtkIdType i = 0; i < points; ++i)
    out.push_back(static_cast<std::uint64_t>(ids->GetVariantValue(i).ToTypeInt64()));
  return out;
}

/// Takes over an unstructured grid's cells; `rows` gets the place of each among all of the grid's.
class GridCells {
 public:
  GridCells(vtkUnstructuredGrid& grid, const std::filesystem::path& path)
      : grid_(grid), path_(path), hidden_(grid) {}

  Status into(CellMesh& out, std::vector<vtkIdType>& rows, ReadReport& report) {
    const vtkIdType count = grid_.GetNumberOfCells();
    vtkUnsignedCharArray* types = grid_.GetCellTypesArray();
    vtkCellArray* cells = grid_.GetCells();
    if (count == 0 || !types || !cells) return {};
    if (types->GetNumberOfTuples() < count || cells->GetNumberOfOffsets() <= count)
      return bad(path_,
                 "fewer cell types or offsets than cells; the file is damaged, export it again");
    out.types.reserve(static_cast<std::size_t>(count));
    out.begins.reserve(static_cast<std::size_t>(count) + 1);
    out.vertices.reserve(static_cast<std::size_t>(cells->GetNumberOfConnectivityIds()));
    rows.reserve(static_cast<std::size_t>(count));
    return cells->IsStorage64Bit() ? copy(*cells->GetOffsetsArray64(),
                                          *cells->GetConnectivityArray64(), out, rows, report)
                                   : copy(*cells->GetOffsetsArray32(),
                                          *cells->GetConnectivityArray32(), out, rows, report);
  }

 private:
  template <class Array>
  Status copy(Array& offsets, Array& ids, CellMesh& out, std::vector<vtkIdType>& rows,
              ReadReport& report) {
    static const Dimensions dimensions;
    const vtkIdType count = grid_.GetNumberOfCells(), idCount = ids.GetNumberOfTuples();
    const unsigned char* types = grid_.GetCellTypesArray()->GetPointer(0);
    const auto* begin = offsets.GetPointer(0);
    const auto* id = ids.GetPointer(0);
    for (vtkIdType i = 0; i < count; ++i) {
      if (dimensions[types[i]] < 3) {
        ++report.ignoredCells;
        continue;
      }
      if (hidden_[i]) continue;
      if (begin[i] < 0 || begin[i + 1] < begin[i] || begin[i + 1] > idCount) {
        return bad(
            path_,
            "cell " + std::to_string(i) +
                " has vertices outside the list of vertices; the file is damaged, export it again");
      }
      if (types[i] == VTK_POLYHEDRON) {
        if (Status added = addPolyhedron(i, out); !added) return added;
      } else {
        for (auto k = begin[i]; k < begin[i + 1]; ++k) out.vertices.push_back(narrowed(id[k]));
      }
      out.types.push_back(types[i]);
      out.begins.push_back(out.vertices.size());
      rows.push_back(i);
    }
    return {};
  }

  Status addPolyhedron(vtkIdType i, CellMesh& out) {
    vtkIdTypeArray* places = grid_.GetFaceLocations();
    vtkIdTypeArray* faces = grid_.GetFaces();
    const auto damaged = [&] {
      return bad(path_,
                 "cell " + std::to_string(i) +
                     " is a polyhedron without its faces; the file is damaged, export it again");
    };
    if (!places || !faces || i >= places->GetNumberOfTuples()) return damaged();
    const vtkIdType end = faces->GetNumberOfTuples();
    vtkIdType at = places->GetValue(i);
    if (at < 0 || at >= end) return damaged();
    const vtkIdType faceCount = faces->GetValue(at++);
    out.vertices.push_back(narrowed(faceCount));
    for (vtkIdType face = 0; face < faceCount; ++face) {
      if (at >= end) return damaged();
      const vtkIdType corners = faces->GetValue(at++);
      if (corners < 0 || corners > end - at) return damaged();
      out.vertices.push_back(narrowed(corners));
      for (vtkIdType k = 0; k < corners; ++k)
        out.vertices.push_back(narrowed(faces->GetValue(at++)));
    }
    return {};
  }

  vtkUnstructuredGrid& grid_;
  const std::filesystem::path& path_;
  Hidden hidden_;
};

/// Any other data set (structured, rectilinear, image), cell by cell.
void copyCells(vtkDataSet& data, CellMesh& out, std::vector<vtkIdType>& rows, ReadReport& report) {
  static const Dimensions dimensions;
  const Hidden hidden(data);
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < data.GetNumberOfCells(); ++i) {
    const int type = data.GetCellType(i);
    if (hidden[i]) continue;
    if (dimensions[type] < 3) {
      ++report.ignoredCells;
      continue;
    }
    data.GetCellPoints(i, ids);
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
      out.vertices.push_back(narrowed(ids->GetId(k)));
    out.types.push_back(static_cast<std::uint8_t>(type));
    out.begins.push_back(out.vertices.size());
    rows.push_back(i);
  }
}

/// The type's name, or an empty text for texts and the like.
std::string typeName(vtkDataArray& array) {
  if (array.GetDataType() == VTK_FLOAT) return "float32";
  if (array.GetDataType() == VTK_DOUBLE) return "float64";
  if (array.GetDataType() == VTK_BIT) return "uint8";
  const bool isSigned = array.GetDataTypeMin() < 0;
  return (isSigned ? "int" : "uint") + std::to_string(8 * array.GetDataTypeSize());
}

/// Takes the tuples of `rows` alone, which ascend.
void keepRows(MeshField& field, const std::vector<vtkIdType>& rows) {
  const std::size_t n = field.components;
  if (rows.size() * n == field.values.size()) return;
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(field.values.data() + static_cast<std::size_t>(rows[i]) * n, n,
                field.values.data() + i * n);
  field.values.resize(rows.size() * n);
}

/// The array's name, or "unnamed-I" where the manifest could not hold it.
std::string nameOf(vtkAbstractArray& array, const std::string& association, int number,
                   ReadReport& report) {
  const std::string name = array.GetName() ? array.GetName() : "";
  if (isStorableName(name)) return name;
  const std::string substitute = "unnamed-" + std::to_string(number);
  report.notes.push_back(association + " field number " + std::to_string(number) +
                         " has no name, or none of at most " + std::to_string(kMaxNameBytes) +
                         " bytes of UTF-8, and is called " + substitute);
  return substitute;
}

class GridFields {
 public:
  GridFields(const FieldNames& wanted, const std::filesystem::path& path, ReadReport& report)
      : wanted_(wanted), path_(path), report_(report) {}

  /// The fields of `data` that are wanted, with the tuples of `rows` (nullptr: all); `tuples` is
  /// what an array must have.
  Status add(vtkFieldData& data, const std::string& association, vtkIdType tuples,
             const std::vector<vtkIdType>* rows, CellMesh& out) {
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
      const std::string name = nameOf(*data.GetAbstractArray(i), association, i, report_);
      vtkDataArray* array = data.GetArray(i);
      if (name == vtkDataSetAttributes::GhostArrayName() || name == kGhostLevels) continue;
      if (!array || array->GetNumberOfComponents() < 1 ||
          array->GetNumberOfComponents() > static_cast<int>(kMaxFieldComponents)) {
        ignore(association, name, array != nullptr);
        continue;
      }
      if (!isOfTheShape(data, array, name) && !isMeant(wanted_, association, name)) {
        out.otherFields.push_back(name);
        continue;
      }
      if (array->GetNumberOfTuples() != tuples) {
        return bad(path_, association + " field " + name + " has " +
                              std::to_string(array->GetNumberOfTuples()) + " tuples for " +
                              std::to_string(tuples) + " " + association + "s; export it again");
      }
      MeshField field{name,
                      static_cast<std::uint32_t>(array->GetNumberOfComponents()),
                      typeName(*array),
                      {},
                      association};
      field.values.resize(static_cast<std::size_t>(tuples) * field.components);
      copyValues(*array, field.values.data());
      if (rows) keepRows(field, *rows);
      out.fields.push_back(std::move(field));
    }
    return {};
  }

 private:
  /// Cells of higher degree are not understood without them (higher_cells.h).
  static bool isOfTheShape(vtkFieldData& data, vtkDataArray* array, const std::string& name) {
    auto* attributes = vtkDataSetAttributes::SafeDownCast(&data);
    return attributes && ((array == attributes->GetHigherOrderDegrees() && name == kDegreesField) ||
                          (array == attributes->GetRationalWeights() && name == kWeightsField));
  }

  void ignore(const std::string& association, const std::string& name, bool hasNumbers) {
    report_.ignoredFields.push_back(name);
    report_.notes.push_back(
        association + " field " + name + " was ignored: " +
        (hasNumbers ? "more than " + std::to_string(kMaxFieldComponents) + " components"
                    : std::string("it holds no numbers")));
  }

  const FieldNames& wanted_;
  const std::filesystem::path& path_;
  ReadReport& report_;
};

}  // namespace

Result<CellMesh> cellsOf(vtkDataSet& data, const FieldNames& fields,
                         const std::filesystem::path& path, ReadReport& report) {
  CellMesh out;
  out.points = pointsOf(data);
  out.pointIds = globalIdsOf(data);
  auto* set = vtkPointSet::SafeDownCast(&data);
  out.pointType = set && set->GetPoints() && set->GetPoints()->GetDataType() == VTK_FLOAT
                      ? "float32"
                      : "float64";
  std::vector<vtkIdType> rows;
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(&data)) {
    if (Status done = GridCells(*grid, path).into(out, rows, report); !done)
      return std::unexpected(done.error());
  } else {
    copyCells(data, out, rows, report);
  }
  if (rows.size() != static_cast<std::size_t>(data.GetNumberOfCells()))
    out.cellIds.assign(rows.begin(), rows.end());

  GridFields read(fields, path, report);
  if (Status done = read.add(*data.GetPointData(), "point", data.GetNumberOfPoints(), nullptr, out);
      !done)
    return std::unexpected(done.error());
  if (Status done = read.add(*data.GetCellData(), "cell", data.GetNumberOfCells(), &rows, out);
      !done)
    return std::unexpected(done.error());
  return out;
}

}  // namespace qtet
