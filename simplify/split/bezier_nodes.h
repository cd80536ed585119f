// Bezier cells have control points where Lagrange cells have nodes on themselves.
#pragma once

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Moves every control point of a Bezier cell to the point of the cell at its node's place.
/// Floating-point fields of points get the values there. The cell is then split as a Lagrange cell
/// is. A control point of several cells depends on what they share alone, and is moved once.
/// kWeightsField, if it is there, holds the weights of rational cells. Errors: bad-input (a number
/// of nodes that no such cell has; weights that are not positive and finite, or too small to divide
/// by). REQUIRES: a mesh that checkCellMesh has passed.
[[nodiscard]] Status placeBezierNodes(CellMesh& mesh);

}  // namespace qtet
