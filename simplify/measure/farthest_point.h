// How far the farthest point of a triangle is from a surface: between what was found and what is
// proven.
#pragma once

#include <array>
#include <cstdint>

#include "simplify/measure/bound_triangles.h"
#include "simplify/mesh/triangle_tree.h"

namespace qtet {

/// The share by which a proven maximum may be above the one that was found.
inline constexpr double kFarthestTolerance = 0.03;

/// Squared distances.
struct FarthestPoint {
  double found = 0;  ///< of some point of the triangle, or what was enough
  double bound = 0;  ///< at least that of every point of the triangle
  /// The surface's triangle that is nearest to the middle, or near enough, or over most of it.
  std::uint32_t nearest = 0;
  /// The triangles that the bound rests on: it holds while they stay.
  BoundTriangles cover{};
};

/// The largest squared distance of the corners to triangle `to`. The distance to a convex set is
/// convex, so no point between the corners is further from it.
[[nodiscard]] double farthestCorner(const Corners& corners, const Corners& to);

/// The largest value that a proven squared distance may have where `found` was found.
[[nodiscard]] double withTolerance(double found);

/// The triangle is cut into pieces until each has a bound of at most withTolerance(max(found,
/// enough)), or until they are many. Then the bound is what it is by then. `guess` makes the first
/// search short. REQUIRES: a tree over one triangle at least.
[[nodiscard]] FarthestPoint farthestPoint(const TriangleTree& tree, const Corners& corners,
                                          std::uint32_t guess, double enough);

}  // namespace qtet
