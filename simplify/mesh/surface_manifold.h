// Where a triangle surface is not a surface: edges and vertices that several sheets share.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

struct NonManifoldParts {
  /// Edges of other than two triangles, lower vertex first, ascending.
  std::vector<std::array<VertexId, 2>> edges;
  /// Vertices whose triangles are not one closed fan, ascending; the ends of such edges are among
  /// them.
  std::vector<VertexId> vertices;
};

[[nodiscard]] NonManifoldParts nonManifoldPartsOf(std::span<const Triangle> surface);

}  // namespace qtet
