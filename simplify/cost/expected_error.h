// By how much fields and boundary differ from linear between one cell and the next. It predicts
// what each is likely to lose when cells are fused (ALGORITHM.md, "The boundary weight").
#pragma once

#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "simplify/cost/cost_parts.h"

namespace qtet {

/// One a part: the mean square error of a cell's linear field at the far corner of the cell beyond
/// a face. The mean is over all faces by volume. It is in the cost's unit (CostPart::scale), all
/// components together. The error of rounding the field to integers is subtracted, which may leave
/// less than 0. In a large mesh some faces stand for all. Their places decide which, so neither
/// numbering nor order matters. REQUIRES: `parts` of point fields of `mesh`.
[[nodiscard]] std::vector<double> expectedFieldErrors(const LatticeMesh& mesh,
                                                      std::span<const CostPart> parts);

/// The mean square of the distance between a boundary triangle's plane and the far corner of the
/// triangle beyond each edge. The mean is over the area, the distance in lattice steps. Creases do
/// not count: fusions keep them, or pay for them alone.
[[nodiscard]] double expectedBoundaryError(const LatticeMesh& mesh);

}  // namespace qtet
