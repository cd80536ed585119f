// The names of a label's values in a .vtu file. Each is an array among the data of the file, such
// as "Material=steel", that holds one integer. Our writer makes them.
#pragma once

#include "simplify/read/vtu/vtu_document.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Gives the mesh's cell fields the names that the document has of their values, at most
/// kMaxLabelNames each. Errors: those of readIntegers.
[[nodiscard]] Status readVtuLabelNames(const VtuFile& file, const VtuDocument& document,
                                       CellMesh& mesh);

}  // namespace qtet
