#include "simplify/legality/allowed_space.h"

#include <algorithm>
#include <cmath>

namespace qtet {
namespace {

/// A tetrahedron that touches more cubes which are not known to be allowed is too large to prove.
constexpr std::size_t kMaxDoubtful = 16;

float floatBelow(double x) { return std::nextafter(static_cast<float>(x), 0.0f); }

}  // namespace

AllowedSpace::AllowedSpace(const FusionMesh& mesh, double tolerance)
    : surface_(mesh),
      tolerance_(tolerance),
      cells_(surface_.tree(), std::vector(surface_.tree().builtOver(), floatBelow(tolerance)),
             tolerance, [this](const Vector3& p) {
               NearestTriangle nearest;
               surface_.tree().nearest(p, nearest);
               return surface_.isInside(p, nearest);
             }) {}

bool AllowedSpace::holds(const Corners& tetrahedron, Known& known) const {
  if (cells_.length() == 0) return surface_.holds(tetrahedron, tolerance_, known.distances);
  known.doubtful.clear();
  cells_.findDoubtful(tetrahedron, kMaxDoubtful, known.doubtful);
  if (known.doubtful.size() > kMaxDoubtful) return false;
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
         surface_.holds(tetrahedron, tolerance_, known.distances, isDoubtful);
}

}  // namespace qtet
