// OpenFOAM's fields: the solver writes values of cells, and VTK offers means at points beside them.
#pragma once

#include <string>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Whether a name asks for a field of points ("point:T"), so that VTK has to make the means.
[[nodiscard]] bool asksForPointFields(const FieldNames& names);

/// Leaves out the point fields that share a cell field's name, except those asked for as
/// "point:NAME". Where none is asked for, a note says how to. Fields that the solver itself wrote
/// at points have names of their own.
void keepFoamFields(const FieldNames& names, CellMesh& mesh, std::vector<std::string>& notes);

}  // namespace qtet
