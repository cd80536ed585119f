// By how much fields and boundary are off linear from one cell to the next: what each is likely to
// lose when cells are fused, before any is (ALGORITHM.md, "The boundary weight").
#pragma once

#include <span>

#include "codec/mesh/mesh.h"
#include "simplify/cost/cost_parts.h"

namespace qtet {

/// The mean square, over the volume, of what a cell's linear fields miss at the far corner of the
/// cell beyond each face, in the cost's unit (CostPart::scale), all components together. What the
/// fields' integers are rounded by is taken off. Of a large mesh some faces speak for all; which,
/// follows from their places, so neither numbering nor order has a say. REQUIRES: `parts` of point
/// fields of `mesh`.
[[nodiscard]] double expectedFieldError(const LatticeMesh& mesh, std::span<const CostPart> parts);

/// The mean square, over the area, of the distance between a boundary triangle's plane and the far
/// corner of the triangle beyond each edge, in lattice steps. Creases do not count: fusions keep
/// them, or pay for them alone.
[[nodiscard]] double expectedBoundaryError(const LatticeMesh& mesh);

}  // namespace qtet
