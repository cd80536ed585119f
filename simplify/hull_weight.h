// What the hull's place counts beside the fields where nobody says (ALGORITHM.md, "The hull's weight").
#pragma once

#include <span>

#include "codec/mesh.h"
#include "simplify/cost_parts.h"

namespace qtet {

/// Of the bounding box, in lattice steps, at least 1.
[[nodiscard]] double diagonalOf(const LatticeMesh& mesh);

/// The weight (CostOptions::hullWeight) with which a hull that is off by d on average counts like fields that are off, on average over the volume, by a few times
/// what they change over d at the boundary. No unit and no field's range has a say. Linear time. REQUIRES: `parts` of point fields of `mesh`,
/// whose boundary is boundaryOf's.
[[nodiscard]] double balancedHullWeight(const LatticeMesh& mesh, std::span<const CostPart> parts);

}  // namespace qtet
