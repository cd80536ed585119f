// The cells of a mesh and which of them share a face: what is cut into parts.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"

namespace qtet {

class FusionMesh;

/// Rows as METIS takes them: those beside cell i are `beside` from begins[i] to begins[i + 1].
/// `weights`, one a neighbour, say what it costs to cut there.
struct CellGraph {
  std::vector<std::int32_t> begins, beside, weights;
};

/// The graph of these live tetrahedra; numbers are indices into `cells`. A face is dear to cut
/// where vertices of it are `old`, by vertex of the mesh: they could not be fused the last time.
[[nodiscard]] CellGraph cellGraphOf(const FusionMesh& mesh, std::span<const CellId> cells,
                                    std::span<const std::uint8_t> old);

/// Cuts the cells of a graph into at most so many parts: the part of each cell. The same graph
/// gives the same parts. It is called by one thread at a time. REQUIRES: parts >= 2.
using Partitioner =
    std::function<std::vector<std::uint32_t>(const CellGraph& graph, std::uint32_t parts)>;

}  // namespace qtet
