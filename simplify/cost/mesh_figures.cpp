#include "simplify/cost/mesh_figures.h"

#include "simplify/cost/boundary_weight.h"
#include "simplify/cost/expected_error.h"

namespace qtet {

LatticeFigures::LatticeFigures(const LatticeMesh& mesh)
    : mesh_(mesh), isOneValue_(oneValueOf(mesh)), labels_(mesh.fields) {
  labels_.add(mesh);
}

std::vector<double> LatticeFigures::fieldErrors(std::span<const CostPart> parts) const {
  return expectedFieldErrors(mesh_, parts);
}

Result<double> LatticeFigures::boundaryWeight(std::span<const CostPart> parts,
                                              std::span<const double> errors) const {
  return balancedBoundaryWeight(mesh_, parts, errors);
}

}  // namespace qtet
