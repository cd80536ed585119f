// T-junctions: boundary points that lie on a boundary triangle which does not have them as a
// corner.
#pragma once

#include <span>
#include <vector>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// How near counts as on a triangle, in parts of its longest edge: above what float32 coordinates
/// are rounded by, far below what is meant.
inline constexpr double kHangingTolerance = 1e-6;

/// The points, ascending. Points that lie at a corner's place are coincident, not hanging. About n
/// log n time for n triangles of like size. REQUIRES: ids below the number of points.
[[nodiscard]] std::vector<VertexId> hangingPointsOf(std::span<const Position> points,
                                                    std::span<const Triangle> boundary);

}  // namespace qtet
