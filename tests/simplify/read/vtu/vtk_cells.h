// A CellMesh of data sets as VTK has read them, to judge our own readers by.
#pragma once

#include <vtkDataSet.h>

#include <filesystem>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet::testing {

/// The volume cells that are visible and no other piece's (ghosts), with the points as they are and
/// the fields meant by `fields`. Cells of lower dimension are counted in the report, fields of
/// texts or too many components noted. Ids are narrowed, not checked (checkCellMesh). Errors:
/// bad-input (no points, arrays whose lengths contradict each other, a coordinate that is none).
[[nodiscard]] Result<CellMesh> cellsOf(vtkDataSet& data, const FieldNames& fields,
                                       const std::filesystem::path& path, ReadReport& report);

}  // namespace qtet::testing
