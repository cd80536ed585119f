// Where a triangle surface is not a surface: edges and vertices that several sheets share.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "codec/mesh.h"

namespace qtet {

struct NonManifoldParts {
  std::vector<std::array<VertexId, 2>> edges;  ///< of a number of triangles other than two, lower vertex first, ascending
  std::vector<VertexId> vertices;              ///< whose triangles are not one closed fan, ascending; the ends of such edges are among them
};

[[nodiscard]] NonManifoldParts nonManifoldPartsOf(std::span<const Triangle> surface);

}  // namespace qtet
