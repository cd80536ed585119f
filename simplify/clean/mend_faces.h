// Quadrilaterals that two cells' tetrahedra cut along different diagonals, as where a ring of an
// odd number of cells is closed by welding.
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

struct MendReport {
  std::uint64_t mended = 0;  ///< quadrilaterals whose sides agree now
  /// Where neither side could be recut without turning a tetrahedron inside out.
  std::uint64_t left = 0;
};

/// Finds four boundary triangles that are the two cuts of one quadrilateral, and recuts one side.
/// The tetrahedra round its diagonal become tetrahedra round the other's. The surface on that side
/// becomes the other side's; every new tetrahedron has a positive volume. Cell fields are inherited
/// from the tetrahedron that has most of the same vertices. New tetrahedra take the places of old
/// ones, then follow at the end. REQUIRES: vertex ids below the number of points.
MendReport mendCrossedFaces(TetMesh& mesh);

}  // namespace qtet
