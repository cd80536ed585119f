#include "simplify/legality/allowed_space.h"

#include "simplify/legality/local_tolerances.h"

namespace qtet {
namespace {

/// A search ends after so many, since there are other places to fuse to.
constexpr int kCuts = 4;

}  // namespace

AllowedSpace::AllowedSpace(const FusionMesh& mesh, double tolerance)
    : surface_(mesh),
      tolerances_(localTolerances(surface_.tree(), tolerance)),
      cells_(surface_.tree(), tolerances_.own, tolerance, [this](const Vector3& p) {
        NearestTriangle nearest;
        surface_.tree().nearest(p, nearest);
        return surface_.isInside(p, nearest);
      }) {}

bool AllowedSpace::holds(const Corners& tetrahedron, DistanceCells& known) const {
  return cells_.isKnown() ? cells_.holds(tetrahedron)
                          : surface_.holds(tetrahedron, tolerances_, known, kCuts);
}

}  // namespace qtet
