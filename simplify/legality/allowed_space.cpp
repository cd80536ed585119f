#include "simplify/legality/allowed_space.h"

#include <algorithm>
#include <cmath>

#include "simplify/legality/local_tolerances.h"

namespace qtet {

AllowedSpace::AllowedSpace(const FusionMesh& mesh, double tolerance, const Rules& rules)
    : surface_(mesh),
      tolerances_(rules.isLocal
                      ? OriginalSurface::Tolerances(localTolerances(surface_.tree(), tolerance))
                      : OriginalSurface::Tolerances(surface_, tolerance)),
      rules_(rules),
      cells_(surface_.tree(), tolerances_.own, tolerance, [this](const Vector3& p) {
        NearestTriangle nearest;
        surface_.tree().nearest(p, nearest);
        return surface_.isInside(p, nearest);
      }) {}

bool AllowedSpace::holds(const Corners& tetrahedron, Known& known) const {
  if (cells_.length() == 0) {
    const auto isAny = [](const Corners&) { return true; };
    return surface_.holds(tetrahedron, tolerances_, known.distances, isAny, rules_.cuts);
  }
  known.doubtful.clear();
  cells_.findDoubtful(tetrahedron, rules_.cubes, known.doubtful);
  if (known.doubtful.size() > rules_.cubes) return false;
  const auto isDoubtful = [&](const Corners& piece) {
    const auto touches = [&](const NearCells::Cell& cell) {
      bool isMet = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax({piece[0][k], piece[1][k], piece[2][k], piece[3][k]});
        isMet &= high >= cell[k] * cells_.length() && low <= (cell[k] + 1) * cells_.length();
      }
      return isMet;
    };
    return std::ranges::any_of(known.doubtful, touches);
  };
  return known.doubtful.empty() ||
         surface_.holds(tetrahedron, tolerances_, known.distances, isDoubtful, rules_.cuts);
}

}  // namespace qtet
