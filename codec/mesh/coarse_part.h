// The mesh that a patch begins with.
#pragma once

#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

/// A base mesh, or the part of a coarser mesh that a patch refines, numbered for itself.
struct CoarsePart {
  std::vector<LatticePoint> points;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Triangle> boundary;  ///< of the solid. Faces to other patches have no triangle.
  /// Vertices that other patches have, too: none of them splits.
  std::vector<VertexId> frozen;
};

}  // namespace qtet
