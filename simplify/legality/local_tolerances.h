// How far a solid may grow at each triangle of its surface, so that no two sheets of it swallow the
// gap between them (ALGORITHM.md, "The envelope's tolerance").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simplify/mesh/triangle_tree.h"

namespace qtet {

/// By triangle of the tree, at most `most`. Also at most a quarter of the way along its normal,
/// outwards, to the next triangle. The one met is bound alike. 0 at degenerate ones, and where
/// `isSeam`. In lattice steps. REQUIRES: the tree is over the triangles 0, 1, 2 ...; `isSeam` has
/// one flag for each, or none.
[[nodiscard]] std::vector<float> localTolerances(const TriangleTree& tree, double most,
                                                 std::span<const std::uint8_t> isSeam = {});

}  // namespace qtet
