// vtkUnstructuredGridQuadricDecimation, the decimator that ours is compared with: a mesh in, a mesh
// out.
#pragma once

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridQuadricDecimation.h>

#include <algorithm>
#include <array>
#include <string>

#include "simplify/mesh/tet_mesh.h"
#include "tests/bench/cpu_clock.h"

namespace qtet::bench {

/// The filter compares lengths with constants of its own, so that how far it gets depends on the
/// unit of length. Points, scalar and boundary weight times this are the same problem in a unit in
/// which it gets further on most meshes ("tuned").
inline constexpr double kTunedScale = 1000;

/// The first point field of one component: the filter knows one scalar and drops every other field.
/// Null: there is none.
[[nodiscard]] inline const MeshField* scalarOf(const TetMesh& mesh) {
  const auto found = std::ranges::find_if(
      mesh.fields, [](const MeshField& f) { return f.components == 1 && !isCellField(f); });
  return found == mesh.fields.end() ? nullptr : &*found;
}

/// Points and scalar times `scale`. The filter needs a scalar: without one it gets zeros.
[[nodiscard]] inline vtkSmartPointer<vtkUnstructuredGrid> gridOf(const TetMesh& mesh,
                                                                 double scale) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Position& p : mesh.points)
    points->InsertNextPoint(scale * p[0], scale * p[1], scale * p[2]);
  vtkNew<vtkFloatArray> scalar;
  const MeshField* field = scalarOf(mesh);
  scalar->SetName(field ? field->name.c_str() : "none");
  scalar->SetNumberOfTuples(static_cast<vtkIdType>(mesh.points.size()));
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    scalar->SetValue(static_cast<vtkIdType>(v),
                     field ? static_cast<float>(scale * field->values[v]) : 0);

  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(points);
  grid->GetPointData()->SetScalars(scalar);
  vtkNew<vtkCellArray> cells;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const std::array<vtkIdType, 4> ids{t[0], t[1], t[2], t[3]};
    cells->InsertNextCell(4, ids.data());
  }
  grid->SetCells(VTK_TETRA, cells);
  return grid;
}

struct Decimated {
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  Seconds seconds;
};

/// `grid`: from gridOf with this `scale`. `reduction`: the fraction of the cells to remove; the
/// filter may stop earlier and does not say so. Timed: Update() alone.
[[nodiscard]] inline Decimated decimate(vtkUnstructuredGrid* grid, double scale, double reduction) {
  vtkNew<vtkUnstructuredGridQuadricDecimation> filter;
  filter->SetInputData(grid);
  filter->SetTargetReduction(reduction);
  filter->SetBoundaryWeight(scale * filter->GetBoundaryWeight());
  const Seconds seconds = timeOf([&] { filter->Update(); });
  return {filter->GetOutput(), seconds};
}

/// Back from a grid of tetrahedra that gridOf scaled by `scale`; the scalar, which the filter
/// leaves without a name, is the field `name`.
[[nodiscard]] inline TetMesh meshOf(vtkUnstructuredGrid* grid, double scale,
                                    const std::string& name) {
  TetMesh mesh;
  for (vtkIdType v = 0; v < grid->GetNumberOfPoints(); ++v) {
    Position p{};
    grid->GetPoint(v, p.data());
    mesh.points.push_back({p[0] / scale, p[1] / scale, p[2] / scale});
  }
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    vtkIdType corners = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCellPoints(c, corners, ids);
    Tetrahedron& t = mesh.tetrahedra.emplace_back();
    std::ranges::transform(ids, ids + t.size(), t.begin(),
                           [](vtkIdType id) { return static_cast<VertexId>(id); });
  }
  if (vtkDataArray* scalar = grid->GetPointData()->GetScalars()) {
    MeshField& field = mesh.fields.emplace_back(MeshField{name, 1, "float64", {}});
    for (vtkIdType v = 0; v < grid->GetNumberOfPoints(); ++v)
      field.values.push_back(scalar->GetComponent(v, 0) / scale);
  }
  return mesh;
}

}  // namespace qtet::bench
