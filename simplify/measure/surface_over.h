// Whether a closed surface passes over the whole of a flat piece, and how far from it. This bounds
// a whole piece without a search for nearest points.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "simplify/measure/bound_triangles.h"
#include "simplify/mesh/triangle_tree.h"

namespace qtet {

/// The surface between two planes that are as far above the piece as below it.
struct SurfaceOver {
  /// Every line along the piece's normal has a place of the surface so near the piece, in lattice
  /// steps. Infinite where that is not proven.
  double height = std::numeric_limits<double>::infinity();
  /// The surface's triangle over the largest share of the piece.
  std::uint32_t triangle = 0;
  /// The triangles that the height rests on.
  BoundTriangles cover{};
};

/// The parts over the piece are cut out of the surface. Where none crosses the planes at +-`most`
/// lattice steps, the signed area of their projections is a multiple of the piece's area. The
/// factor is the number of layers, the same over each point of the piece. If it is not 0, the
/// surface is over all of it.
/// REQUIRES: `piece` is flat and convex with `normal` as its unit normal, seen anticlockwise, and
/// has at most kMaxCorners corners. The tree's surface is closed: the number of triangles on each
/// side of an edge is even with their directions, as for a mesh's boundary.
[[nodiscard]] SurfaceOver surfaceOver(const TriangleTree& surface, std::span<const Vector3> piece,
                                      const Vector3& normal, double most);

/// Corners of a piece.
inline constexpr std::size_t kMaxCorners = 8;

}  // namespace qtet
