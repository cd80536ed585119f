// A mesh under simplification cut into parts, whose cells are simplified apart (PARTS.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/mesh/fusion_mesh.h"
#include "simplify/mesh/workers.h"
#include "simplify/parts/cell_graph.h"

namespace qtet {

struct CutMesh {
  std::vector<std::vector<CellId>> parts;  ///< live tetrahedra, ascending; no part is empty
  std::vector<std::uint8_t> isSeam;        ///< by vertex: in cells of several parts
  double innerShare = 0;                   ///< of the vertices in use, those that are no seam
};

/// Cells that are cut by one call of the partitioner, at most: it takes some 200 bytes for each.
/// Planes cut the mesh into such blocks before.
inline constexpr std::size_t kMaxBlockCells = 400'000;

/// Cuts the live tetrahedra into parts of about so many cells. `band`: its planes lie elsewhere
/// than those of the band before. `old`: isSeam of the band before; empty in the first one.
[[nodiscard]] CutMesh cutMesh(const FusionMesh& mesh, const Partitioner& partition,
                              std::size_t cellsOfAPart, std::uint32_t band,
                              std::span<const std::uint8_t> old, Workers& workers,
                              std::size_t blockCells = kMaxBlockCells);

}  // namespace qtet
