#include "simplify/cost/cost_frame.h"

#include <cmath>

#include "simplify/cost/boundary_weight.h"
#include "simplify/cost/expected_error.h"

namespace qtet {

CostFrame::CostFrame(const LatticeMesh& mesh, const CostOptions& options)
    : parts(costPartsOf(mesh, options.fieldWeights)),
      basis(mesh, parts),
      diagonal(diagonalOf(mesh)),
      boundaryWeight(options.boundaryWeight.value_or(0)),
      labels(options.labels),
      boundaryFactor(options.boundaryFactor),
      planeScale(std::ldexp(0.25, -3 * mesh.lattice.bits)) {
  if (!options.boundaryWeight && !parts.empty())
    boundaryWeight = balancedBoundaryWeight(mesh, parts, expectedFieldErrors(mesh, parts));
  if (!basis.isDirect()) return;
  for (const CostPart& part : parts) {
    const FieldInfo& info = mesh.fields[part.field];
    limits.insert(limits.end(), info.components, part.scale * (std::ldexp(1.0, info.bits) - 1));
  }
}

}  // namespace qtet
