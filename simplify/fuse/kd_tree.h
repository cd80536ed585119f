// A balanced k-d tree over the tetrahedra of a mesh: which leaf each of them belongs to
// (ALGORITHM.md, "Bands").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

/// Leaves of about `cellsPerLeaf` cells: the tree's depth. REQUIRES: cellsPerLeaf > 0.
[[nodiscard]] std::uint32_t kdDepth(std::size_t cells, std::size_t cellsPerLeaf);

/// One of 2^depth leaves a tetrahedron; the topmost bit says which half of the whole. Each node is
/// split at the median barycentre along the longest axis of the box of its barycentres, ties by
/// index. All of this is in integers, the same everywhere. REQUIRES: lattice coordinates below
/// 2^28, depth <= 18.
[[nodiscard]] std::vector<std::uint32_t> kdLeaves(std::span<const LatticePoint> points,
                                                  std::span<const Tetrahedron> tetrahedra,
                                                  std::uint32_t depth);

}  // namespace qtet
