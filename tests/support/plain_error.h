// The error of a simplified mesh, measured by the definitions: every sample is compared with all
// cells and all boundary triangles. Shares nothing with simplify/measure.
#pragma once

#include <cstddef>

#include "codec/mesh/mesh.h"

namespace qtet::testing {

struct PlainError {
  /// Root mean square over the original's volume, all point fields together, each over its range;
  /// outside of the level its nearest boundary point counts.
  double field = 0;
  /// The same over the original's boundary, at the level's nearest boundary points.
  double wall = 0;
  /// The larger of the two one-sided distances of the boundaries, at their vertices and at samples,
  /// over the diagonal of the original's bounding box.
  double hausdorff = 0;
};

/// `samples` places in the volume and on each boundary, always the same ones. REQUIRES: both on one
/// lattice of 20 bits at most, with the same fields, no point field constant.
[[nodiscard]] PlainError plainError(const LatticeMesh& original, const LatticeMesh& level,
                                    std::size_t samples);

/// The angle between two faces of a cell, in degrees, that this fraction of all such angles does
/// not pass.
[[nodiscard]] double angleAt(const LatticeMesh& mesh, double fraction);

}  // namespace qtet::testing
