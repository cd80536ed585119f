// Betti numbers of a tetrahedral complex over Z/2, from the ranks of its boundary matrices.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "codec/mesh/mesh.h"

namespace qtet::testing {

/// Components, tunnels, cavities and closed 3-cycles (none in space). Exact for complexes of any
/// kind, pinched ones too. REQUIRES: no face of more than two cells, four different vertices a
/// cell.
[[nodiscard]] std::array<std::int64_t, 4> bettiNumbers(std::span<const Tetrahedron> cells);

}  // namespace qtet::testing
