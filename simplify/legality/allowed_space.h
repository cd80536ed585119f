// Where the solid may grow: the original one and what is near it (ALGORITHM.md, "The envelope's
// tolerance").
#pragma once

#include "simplify/legality/distance_cells.h"
#include "simplify/legality/near_cells.h"
#include "simplify/legality/original_surface.h"

namespace qtet {

/// Reading is safe from any thread.
class AllowedSpace {
 public:
  using Corners = OriginalSurface::Corners;
  /// The solid of the mesh as it is now, and `tolerance` lattice steps more at most, but none at
  /// seams (OriginalSurface).
  AllowedSpace(const FusionMesh& mesh, double tolerance,
               CellId firstSeam = OriginalSurface::kNoSeam);

  /// All of the tetrahedron is allowed. False also where that was not proved within a bounded
  /// number of steps. `known`: of this space alone. REQUIRES: corners in [0, 2^30)^3.
  [[nodiscard]] bool holds(const Corners& tetrahedron, DistanceCells& known) const;
  [[nodiscard]] const OriginalSurface& surface() const { return surface_; }
  [[nodiscard]] const OriginalSurface::Tolerances& tolerances() const { return tolerances_; }

 private:
  OriginalSurface surface_;
  OriginalSurface::Tolerances tolerances_;
  NearCells cells_;
};

}  // namespace qtet
