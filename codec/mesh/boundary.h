// The boundary of a tetrahedral mesh: the faces that belong to one cell.
#pragma once

#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

/// `kCellFaces[i]`: the corners of the face opposite corner i, counter-clockwise seen from outside
/// a cell of positive volume.
inline constexpr std::array<std::array<int, 3>, 4> kCellFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

[[nodiscard]] inline Triangle cellFace(const Tetrahedron& cell, int opposite) {
  const auto& corner = kCellFaces[static_cast<std::size_t>(opposite)];
  return {cell[static_cast<std::size_t>(corner[0])], cell[static_cast<std::size_t>(corner[1])],
          cell[static_cast<std::size_t>(corner[2])]};
}

/// The faces of exactly one cell, ordered by the cell's slot and then by the opposite corner 0..3,
/// each as cellFace gives it. Linear time; memory grows with the largest vertex id, so ids from
/// outside are compared with the vertex count before. Once `stopped` is true it gives up, and the
/// faces are unspecified. REQUIRES: no kGhost among the vertices, four different vertices a cell.
[[nodiscard]] std::vector<Triangle> boundaryOf(std::span<const Tetrahedron> tetrahedra,
                                               const std::atomic<bool>* stopped = nullptr);

/// A surface as a mesh of its own: the vertices that it uses, in their order, and its triangles as
/// indices into them.
struct CompactTriangles {
  std::vector<VertexId> vertices;
  std::vector<Triangle> triangles;
};
/// REQUIRES: ids below `vertexCount`.
[[nodiscard]] CompactTriangles compactTriangles(std::span<const Triangle> triangles,
                                                std::size_t vertexCount);

}  // namespace qtet
