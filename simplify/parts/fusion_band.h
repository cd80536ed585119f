// A band of fusions (PARTS.md): the mesh is cut into parts, each is simplified alone, and what they
// did becomes levels of the whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/fuse/fusion_loop.h"
#include "simplify/mesh/workers.h"
#include "simplify/parts/cut_mesh.h"
#include "simplify/parts/mesh_part.h"

namespace qtet {

/// Levels of parts as levels of the whole: by part and level, the number of the whole's. A level
/// holds at most one of each part, and a part's follow each other. They are in the order of their
/// keys, so that what is cheap everywhere comes first.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> levelsOfTheWhole(
    std::span<const std::vector<PartLevel>> parts, std::size_t cells);

/// Fuses a band in the parts of `cut`, which leave `target` tetrahedra in all. Their fusions are
/// then done to the whole, from level `levels` on. Returns the number of levels then.
[[nodiscard]] std::uint32_t fuseBand(FusionState& whole, const FusionFrame& frame,
                                     const FusionOptions& options, Workers& workers,
                                     const CutMesh& cut, std::size_t target, std::uint32_t levels);

}  // namespace qtet
