// The weight of the boundary's place beside the fields where nobody gives one (ALGORITHM.md, "The
// boundary weight").
#pragma once

#include <span>

#include "codec/mesh/mesh.h"
#include "simplify/cost/cost_parts.h"

namespace qtet {

/// The diagonal of the bounding box, in lattice steps, at least 1.
[[nodiscard]] double diagonalOf(const LatticeMesh& mesh);

/// The weight (CostOptions::boundaryWeight). By its worth, a boundary off by d on average counts
/// like fields off by somewhat more than their change over d. The change is that at the boundary,
/// the fields' error the average over the volume. By the balance, the boundary's expected error
/// counts a quarter as much as the fields' (expected_error.h). The weight is the geometric mean of
/// both, or the worth if that is less. It depends on no unit and on no field's range.
/// `fieldErrors` are expectedFieldErrors. REQUIRES: `parts` of point fields of `mesh`, whose
/// boundary is boundaryOf's.
[[nodiscard]] double balancedBoundaryWeight(const LatticeMesh& mesh,
                                            std::span<const CostPart> parts,
                                            std::span<const double> fieldErrors);

/// Sums over the cells of a mesh that may come in pieces.
struct BoundarySums {
  double volume = 0;  ///< of cells of positive volume
  double area = 0;    ///< of their boundary triangles
  double steep = 0;   ///< the sum of the fields' squared gradients there, times the area

  /// Adds the cells of `mesh`, whose boundary is in the order of its cells.
  void add(const LatticeMesh& mesh, std::span<const CostPart> parts);
};
/// The same by the sums over the mesh, its diagonalOf and its expectedBoundaryError.
[[nodiscard]] double balancedBoundaryWeight(const BoundarySums& sums, double diagonal,
                                            double boundaryError,
                                            std::span<const double> fieldErrors);

}  // namespace qtet
