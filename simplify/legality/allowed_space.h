// Where the solid may grow: the original one and what is near it (ALGORITHM.md, "The envelope's
// tolerance").
#pragma once

#include <cstddef>
#include <vector>

#include "simplify/legality/distance_cells.h"
#include "simplify/legality/near_cells.h"
#include "simplify/legality/original_surface.h"

namespace qtet {

/// Reading is safe from any thread.
class AllowedSpace {
 public:
  using Corners = OriginalSurface::Corners;
  /// One thread's knowledge of one space.
  struct Known {
    DistanceCells distances;
    std::vector<NearCells::Cell> doubtful;
  };

  /// How hard a proof is tried, since there are other places to fuse to; and what is allowed.
  struct Rules {
    /// A tetrahedron that touches more cubes which are not known to be allowed is refused.
    std::size_t cubes = 4;
    int cuts = 4;         ///< of OriginalSurface::holds
    bool isLocal = true;  ///< the tolerance: less where another sheet of the boundary is near
  };

  /// The solid of the mesh as it is now, and `tolerance` lattice steps more at most.
  AllowedSpace(const FusionMesh& mesh, double tolerance, const Rules& rules);
  AllowedSpace(const FusionMesh& mesh, double tolerance) : AllowedSpace(mesh, tolerance, Rules()) {}

  /// All of the tetrahedron is allowed. False also where that was not proved within a bounded
  /// number of steps. REQUIRES: corners in [0, 2^30)^3.
  [[nodiscard]] bool holds(const Corners& tetrahedron, Known& known) const;
  [[nodiscard]] const OriginalSurface& surface() const { return surface_; }
  [[nodiscard]] const OriginalSurface::Tolerances& tolerances() const { return tolerances_; }

 private:
  OriginalSurface surface_;
  OriginalSurface::Tolerances tolerances_;
  Rules rules_;
  NearCells cells_;
};

}  // namespace qtet
