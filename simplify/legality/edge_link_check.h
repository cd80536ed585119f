// The link condition of an edge (ALGORITHM.md, "Legality"): the fastest way to know that fusing it
// keeps topology.
#pragma once

#include <cstddef>

#include "simplify/legality/local_star.h"

namespace qtet {

/// Cells round an edge that edgeKeepsTopology can tell apart.
inline constexpr std::size_t kMaxRing = 64;

/// Whether fusing the edge keeps topology and can be described by the log. REQUIRES: the star of an
/// edge, neither vertex singular, at most kMaxRing deleted cells.
[[nodiscard]] bool edgeKeepsTopology(const LocalStar& star);

}  // namespace qtet
