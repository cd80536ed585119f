#include "simplify/cost/cost_frame.h"

#include <cmath>
#include <utility>

#include "simplify/cost/boundary_weight.h"
#include "simplify/cost/expected_error.h"

namespace qtet {

namespace {

CostOptions balanced(const LatticeMesh& mesh, std::span<const CostPart> parts,
                     CostOptions options) {
  if (!options.boundaryWeight)
    options.boundaryWeight =
        parts.empty() ? 0 : balancedBoundaryWeight(mesh, parts, expectedFieldErrors(mesh, parts));
  return options;
}

}  // namespace

CostFrame::CostFrame(const LatticeMesh& mesh, const CostOptions& options)
    : CostFrame(mesh, costPartsOf(mesh, options.fieldWeights), options) {}

CostFrame::CostFrame(const LatticeMesh& mesh, const std::vector<CostPart>& theParts,
                     const CostOptions& options)
    : CostFrame(mesh.fields, theParts, CostBasis(mesh, theParts), mesh.lattice.bits,
                diagonalOf(mesh), balanced(mesh, theParts, options)) {}

CostFrame::CostFrame(std::span<const FieldInfo> fields, std::vector<CostPart> theParts,
                     CostBasis theBasis, int latticeBits, double theDiagonal,
                     const CostOptions& options)
    : parts(std::move(theParts)),
      basis(std::move(theBasis)),
      diagonal(theDiagonal),
      boundaryWeight(options.boundaryWeight.value()),
      labels(options.labels),
      boundaryFactor(options.boundaryFactor),
      planeScale(std::ldexp(0.25, -3 * latticeBits)) {
  if (!basis.isDirect()) return;
  for (const CostPart& part : parts) {
    const FieldInfo& info = fields[part.field];
    limits.insert(limits.end(), info.components, part.scale * (std::ldexp(1.0, info.bits) - 1));
  }
}

}  // namespace qtet
