// Whether two triangles of the lattice share more than they may, exactly.
#pragma once

#include <array>

#include "simplify/mesh/vector3.h"

namespace qtet {

/// A triangle of a surface: its vertices' numbers, and where they are.
struct PlacedTriangle {
  std::array<VertexId, 3> vertex{};
  std::array<LatticePoint, 3> at{};
};

/// The triangles share a place that is not on a vertex or edge they have in common by number. Also
/// true where they have all three vertices in common, or where one has no area. Such a surface
/// cannot be distinguished from one that meets itself. REQUIRES: points as orientation() does.
[[nodiscard]] bool overlap(const PlacedTriangle& one, const PlacedTriangle& other);

}  // namespace qtet
