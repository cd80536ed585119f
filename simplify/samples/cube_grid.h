// Cubes in rows, cut into tetrahedra: what most samples are bent from.
#pragma once

#include <array>
#include <cstddef>

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// The numbers of cubes along the axes. Points are numbered along x first, then y, then z.
struct CubeGrid {
  std::array<VertexId, 3> cubes{};

  [[nodiscard]] VertexId pointAt(const std::array<VertexId, 3>& at) const {
    return (at[2] * (cubes[1] + 1) + at[1]) * (cubes[0] + 1) + at[0];
  }
  [[nodiscard]] std::size_t tetrahedra() const {
    return std::size_t{6} * cubes[0] * cubes[1] * cubes[2];
  }
  /// Calls visit(point) for the points in their order; the point counts the cubes before it.
  template <class Visit>
  void forEachPoint(const Visit& visit) const {
    std::array<VertexId, 3> at{};
    for (at[2] = 0; at[2] <= cubes[2]; ++at[2])
      for (at[1] = 0; at[1] <= cubes[1]; ++at[1])
        for (at[0] = 0; at[0] <= cubes[0]; ++at[0]) visit(at);
  }
  /// Each cube's six tetrahedra (Kuhn), positive where x, y, z are right-handed. Neighbours cut
  /// their common side alike.
  [[nodiscard]] std::vector<Tetrahedron> cells() const;
};

}  // namespace qtet
