// Joining points that lie within a distance of one another: the cut of an O-grid, blocks that were
// stored apart.
#pragma once

#include <cstdint>
#include <string_view>

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Every point within `distance` (in the mesh's units, 0: at the very same place) of an earlier one
/// that stays is named by that one's id in all cells; the earlier one's values stay. No point goes:
/// those of no cell are dropped by cleaning. Where points move, they must lie within `distance` at
/// every instant: `motion` names the series of displacements, as ReadReport::motion does. Returns
/// how many were joined. REQUIRES: finite coordinates and displacements, a distance >= 0, vertex
/// ids below the number of points (counts in a polyhedron's stream apart).
std::uint64_t weldPoints(CellMesh& mesh, double distance, std::string_view motion = {});

}  // namespace qtet
