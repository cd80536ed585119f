#include "simplify/legality/allowed_space.h"

#include <cassert>
#include <cmath>
#include <cstdint>

#include "simplify/legality/local_tolerances.h"

namespace qtet {
namespace {

/// A search ends after so many, since there are other places to fuse to.
constexpr int kCuts = 8;
/// Squares of the tolerance's length in a surface, for each of its triangles, at most. Beyond them
/// the cubes take longer to make than the searches that they spare (measured on 16 meshes).
constexpr double kSquaresATriangle = 6.4;

bool areCubesWorthIt(const TriangleTree& tree, std::size_t triangles, double tolerance) {
  double area = 0;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const auto [a, b, c] = tree.corners(t);
    const Vector3 normal = cross(b - a, c - a);
    area += 0.5 * std::sqrt(dot(normal, normal));
  }
  return area <= kSquaresATriangle * tolerance * tolerance * static_cast<double>(triangles);
}

}  // namespace

AllowedSpace::AllowedSpace(const FusionMesh& mesh, double tolerance, CellId firstSeam)
    : surface_(mesh, firstSeam),
      tolerances_(localTolerances(surface_.tree(), tolerance, surface_.isSeam())) {
  assert(tolerance > 0 && tolerances_.own.size() == surface_.tree().builtOver());
  assert(tolerances_.least >= 0 && tolerances_.most <= tolerance);
  if (!areCubesWorthIt(surface_.tree(), tolerances_.own.size(), tolerance)) return;
  cells_ = NearCells(surface_.tree(), tolerances_.own, tolerance, [this](const Vector3& p) {
    NearestTriangle nearest;
    surface_.tree().nearest(p, nearest);
    return surface_.isInside(p, nearest);
  });
}

bool AllowedSpace::holds(const Corners& tetrahedron, DistanceCells& known) const {
  return cells_.isKnown() ? cells_.holds(tetrahedron)
                          : surface_.holds(tetrahedron, tolerances_, known, kCuts);
}

}  // namespace qtet
