// The part of a fusion's cost that follows from the whole mesh. Parts of a mesh share it, so that
// everything counts as it does in the whole.
#pragma once

#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "simplify/cost/cost_basis.h"
#include "simplify/cost/cost_options.h"
#include "simplify/cost/cost_parts.h"

namespace qtet {

struct CostFrame {
  CostFrame(const LatticeMesh& mesh, const CostOptions& options);
  /// The same of a mesh that is not at hand: its fields, the bits of its lattice, its diagonalOf.
  /// REQUIRES: a boundary weight.
  CostFrame(std::span<const FieldInfo> fields, std::vector<CostPart> theParts, CostBasis theBasis,
            int latticeBits, double theDiagonal, const CostOptions& options);

  CostFrame(const LatticeMesh& mesh, const std::vector<CostPart>& theParts,
            const CostOptions& options);

  std::vector<CostPart> parts;  ///< the fields that count
  CostBasis basis;
  /// Where basis.isDirect(), a component's largest value; the smallest is 0.
  std::vector<double> limits{};
  double diagonal = 1;        ///< of the bounding box, in lattice steps
  double boundaryWeight = 0;  ///< given, or found; without fields of no account
  std::vector<LabelCost> labels;
  double boundaryFactor = 10;  ///< CostOptions::boundaryFactor
  /// The factor of all planes' quadrics, without fields. Normals are twice an area, so a quarter of
  /// their square counts. A power of two keeps lengths to the sixth below the largest float.
  double planeScale = 1;
};

}  // namespace qtet
