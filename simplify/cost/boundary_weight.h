// What the boundary's place counts beside the fields where nobody says (ALGORITHM.md, "The boundary
// weight").
#pragma once

#include <span>

#include "codec/mesh/mesh.h"
#include "simplify/cost/cost_parts.h"

namespace qtet {

/// Of the bounding box, in lattice steps, at least 1.
[[nodiscard]] double diagonalOf(const LatticeMesh& mesh);

/// The weight (CostOptions::boundaryWeight) with which a boundary that is off by d on average
/// counts like fields that are off, on average over the volume, by a few times what they change
/// over d at the boundary. No unit and no field's range has a say. Linear time. REQUIRES: `parts`
/// of point fields of `mesh`, whose boundary is boundaryOf's.
[[nodiscard]] double balancedBoundaryWeight(const LatticeMesh& mesh,
                                            std::span<const CostPart> parts);

}  // namespace qtet
