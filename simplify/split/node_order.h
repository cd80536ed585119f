// The order of the nodes of Lagrange and Bezier cells in VTK's files (VTK_LAGRANGE_HEXAHEDRON and
// its kin): corners, then nodes on edges, on faces, and within.
#pragma once

#include <array>

namespace qtet {

/// The number of the node `i`, `j`, `k` steps from corner 0. REQUIRES: a node of the cell, degrees
/// of 1 and more.
[[nodiscard]] int hexahedronNode(const std::array<int, 3>& degrees, int i, int j, int k);
/// `degrees`: of the triangles twice, and along the wedge. REQUIRES: as above.
[[nodiscard]] int wedgeNode(const std::array<int, 3>& degrees, int i, int j, int k);
/// REQUIRES: as above.
[[nodiscard]] int tetrahedronNode(int degree, int i, int j, int k);

}  // namespace qtet
