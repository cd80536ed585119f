// OpenFOAM's fields. The solver writes values of cells. A picture of constants per cell is coarse,
// and its log takes twice the bytes, so means at points are the default, as in ParaView.
#pragma once

#include <string>

#include "simplify/read/options/read_options.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// The names to read from the files, where foamFieldsAtPoints makes the fields that `names` mean:
/// "point:T" needs the values of cells.
[[nodiscard]] FieldNames foamFieldsToRead(const FieldNames& names);

/// Makes point fields of float fields of cells: at each point the mean over its cells, weighted by
/// their volumes. A field of cells stays if `names` has it as "cell:NAME", or if it holds integers.
/// A point field that the solver wrote itself stays as it is. Gives the name of the first one that
/// it made, or nothing.
std::string foamFieldsAtPoints(const FieldNames& names, CellMesh& mesh);

/// The note on means. `field`: one of them.
[[nodiscard]] std::string noteOfMeans(const CellMesh& mesh, const std::string& field);

}  // namespace qtet
