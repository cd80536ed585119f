// The exact sign of a tetrahedron's volume in floating-point coordinates.
#pragma once

#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// Six times the signed volume, (b-a) x (c-a) . (d-a), rounded.
[[nodiscard]] double roundedVolume6(const Position& a, const Position& b, const Position& c,
                                    const Position& d);

/// The sign of the exact volume, -1, 0 or +1. REQUIRES: finite coordinates.
[[nodiscard]] int volumeSign(const Position& a, const Position& b, const Position& c,
                             const Position& d);

}  // namespace qtet
