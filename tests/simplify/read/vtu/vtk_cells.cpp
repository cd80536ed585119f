#include "tests/simplify/read/vtu/vtk_cells.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>

#include "codec/coding/float_bits.h"
#include "simplify/read/options/bad_file.h"
#include "simplify/read/options/grid_parts.h"
#include "simplify/split/higher_cells.h"

namespace qtet::testing {
namespace {

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

static_assert(kElsewhere == (vtkDataSetAttributes::DUPLICATECELL |
                             vtkDataSetAttributes::REFINEDCELL | vtkDataSetAttributes::HIDDENCELL));

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
  for (const char* name : kGlobalIdNames)
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

  Status into(CellMesh& out, std::vector<std::uint64_t>& rows, ReadReport& report) {
    const vtkIdType count = grid_.GetNumberOfCells();
    vtkUnsignedCharArray* types = grid_.GetCellTypesArray();
    vtkCellArray* cells = grid_.GetCells();
    if (count == 0 || !types || !cells) return {};
    if (types->GetNumberOfTuples() < count || cells->GetNumberOfOffsets() <= count)
      return badFile(
          path_, "fewer cell types or offsets than cells; the file is damaged, export it again");
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
  Status copy(Array& offsets, Array& ids, CellMesh& out, std::vector<std::uint64_t>& rows,
              ReadReport& report) {
    const vtkIdType count = grid_.GetNumberOfCells(), idCount = ids.GetNumberOfTuples();
    const unsigned char* types = grid_.GetCellTypesArray()->GetPointer(0);
    const auto* begin = offsets.GetPointer(0);
    const auto* id = ids.GetPointer(0);
    for (vtkIdType i = 0; i < count; ++i) {
      if (dimensionOf(types[i]) < 3) {
        ++report.ignoredCells;
        continue;
      }
      if (hidden_[i]) continue;
      if (begin[i] < 0 || begin[i + 1] < begin[i] || begin[i + 1] > idCount) {
        return badFile(path_, verticesOutside(static_cast<std::uint64_t>(i)));
      }
      if (types[i] == VTK_POLYHEDRON) {
        if (Status added = addPolyhedron(i, out); !added) return added;
      } else {
        for (auto k = begin[i]; k < begin[i + 1]; ++k) out.vertices.push_back(narrowedId(id[k]));
      }
      out.types.push_back(types[i]);
      out.begins.push_back(out.vertices.size());
      rows.push_back(static_cast<std::uint64_t>(i));
    }
    return {};
  }

  Status addPolyhedron(vtkIdType i, CellMesh& out) {
    vtkIdTypeArray* places = grid_.GetFaceLocations();
    vtkIdTypeArray* faces = grid_.GetFaces();
    if (places && faces && i < places->GetNumberOfTuples() && places->GetValue(i) >= 0) {
      auto at = static_cast<std::size_t>(places->GetValue(i));
      if (appendFaces(facesOf(*faces), at, out)) return {};
    }
    return badFile(path_, withoutFaces(static_cast<std::uint64_t>(i)));
  }

  static std::span<const std::int64_t> facesOf(vtkIdTypeArray& faces) {
    static_assert(sizeof(vtkIdType) == sizeof(std::int64_t));
    return {reinterpret_cast<const std::int64_t*>(faces.GetPointer(0)),
            static_cast<std::size_t>(faces.GetNumberOfTuples())};
  }

  vtkUnstructuredGrid& grid_;
  const std::filesystem::path& path_;
  Hidden hidden_;
};

/// Any other data set (structured, rectilinear, image), cell by cell.
void copyCells(vtkDataSet& data, CellMesh& out, std::vector<std::uint64_t>& rows,
               ReadReport& report) {
  const Hidden hidden(data);
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < data.GetNumberOfCells(); ++i) {
    const int type = data.GetCellType(i);
    if (hidden[i]) continue;
    if (dimensionOf(static_cast<std::uint8_t>(type)) < 3) {
      ++report.ignoredCells;
      continue;
    }
    data.GetCellPoints(i, ids);
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
      out.vertices.push_back(narrowedId(ids->GetId(k)));
    out.types.push_back(static_cast<std::uint8_t>(type));
    out.begins.push_back(out.vertices.size());
    rows.push_back(static_cast<std::uint64_t>(i));
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

class GridFields {
 public:
  GridFields(const FieldNames& wanted, const std::filesystem::path& path, ReadReport& report)
      : choice_(wanted, report), path_(path) {}

  /// The fields of `data` that are wanted, with the tuples of `rows` (nullptr: all); `tuples` is
  /// what an array must have.
  Status add(vtkFieldData& data, const std::string& association, vtkIdType tuples,
             const std::vector<std::uint64_t>* rows, CellMesh& out) {
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
      vtkAbstractArray& any = *data.GetAbstractArray(i);
      vtkDataArray* array = data.GetArray(i);
      const char* given = any.GetName();
      const auto name =
          choice_.nameOf({given ? given : "", i,
                          static_cast<std::uint64_t>(std::max(0, any.GetNumberOfComponents())),
                          array != nullptr, given && isOfTheShape(data, array, given)},
                         association, out);
      if (!name) continue;
      if (array->GetNumberOfTuples() != tuples) {
        return badFile(path_, association + " field " + *name + " has " +
                                  std::to_string(array->GetNumberOfTuples()) + " tuples for " +
                                  std::to_string(tuples) + " " + association +
                                  "s; export it again");
      }
      MeshField field{*name,
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

  FieldChoice choice_;
  const std::filesystem::path& path_;
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
  std::vector<std::uint64_t> rows;
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(&data)) {
    if (Status done = GridCells(*grid, path).into(out, rows, report); !done)
      return std::unexpected(done.error());
  } else {
    copyCells(data, out, rows, report);
  }
  if (rows.size() != static_cast<std::size_t>(data.GetNumberOfCells())) out.cellIds = rows;

  GridFields read(fields, path, report);
  if (Status done = read.add(*data.GetPointData(), "point", data.GetNumberOfPoints(), nullptr, out);
      !done)
    return std::unexpected(done.error());
  if (Status done = read.add(*data.GetCellData(), "cell", data.GetNumberOfCells(), &rows, out);
      !done)
    return std::unexpected(done.error());
  return out;
}

}  // namespace qtet::testing
