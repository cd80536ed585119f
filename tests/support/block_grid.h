// Block-structured meshes cut into tetrahedra: small stand-ins for the paper's data sets.
#pragma once

#include <array>
#include <functional>

#include "simplify/mesh/tet_mesh.h"

namespace qtet::testing {

/// A grid of cells[0] x cells[1] x cells[2] hexahedra, each cut into five positive tetrahedra;
/// neighbours alternate, so that their faces fit. `place` puts grid point (i, j, k) into space. One
/// scalar point field, "Distance" from the origin.
[[nodiscard]] TetMesh blockGrid(std::array<int, 3> cells,
                                const std::function<Position(int, int, int)>& place);

/// A ring of `round` cells, each `across` cells wide and high, whose two ends lie at the same place
/// but share no point. With an odd number of cells round, the diagonals of the ends cross.
[[nodiscard]] TetMesh slitRing(int round, int across);

}  // namespace qtet::testing
