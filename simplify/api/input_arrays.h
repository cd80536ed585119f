// A mesh in the arrays of a C caller as a TetMesh.
#pragma once

#include "proto/error.h"
#include "simplify/api/qtet_simplify.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// A copy of the arrays, in the types that the mesh states; what they hold is for checkArrays to
/// judge. Ids that are no point become kGhost. Errors: bad-input (a null array, an unknown type or
/// association), limit-exceeded (found before anything is allocated).
[[nodiscard]] Result<TetMesh> meshOfArrays(const qtet_input_mesh& mesh);

}  // namespace qtet
