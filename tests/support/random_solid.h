// Random small solids of tetrahedra for property tests: tunnels, cavities, several parts, cells
// that touch in an edge or a vertex.
#pragma once

#include <cstdint>
#include <string>

#include "codec/mesh/mesh.h"

namespace qtet::testing {

struct RandomSolid {
  LatticeMesh mesh;
  std::string description;  ///< what the seed chose, for a failing test's message
};

/// A grid of 2 to 6 cubes an axis with even, graded or flat spacing. Its inner points are moved at
/// random, and each cube has six (Kuhn) or five tetrahedra. Then cubes and, for some seeds, single
/// tetrahedra are removed at random. At least one cell. Embedded: no two cells overlap. Two fields,
/// none for some seeds. The same on every machine.
[[nodiscard]] RandomSolid randomSolid(std::uint32_t seed);

}  // namespace qtet::testing
