// A part of a mesh under simplification, as a mesh of its own. Its fusions are those that the whole
// would do if all other vertices were kept, and if no other boundary were near.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/record/fusion_history.h"
#include "simplify/fuse/fusion_loop.h"
#include "simplify/fuse/fusion_state.h"

namespace qtet {

/// The outcome for a part. Its numbers are its own: `vertices` and `cells` have the whole's.
struct PartFusions {
  std::vector<VertexId> vertices;  ///< ascending; those that were fused have none yet
  /// Its tetrahedra, ascending, then its boundary triangles; kNoCell where that is a seam.
  std::vector<CellId> cells;
  FusionHistory history;
  PartLevels done;
};
inline constexpr CellId kNoCell = ~CellId{0};

/// Room for a part's numbers, by vertex of the whole: kGhost for all, before and after.
using PartNumbers = std::vector<VertexId>;

/// Fuses within these tetrahedra of the whole, ascending, until `end`. No vertex of `isSeam`, by
/// vertex of the whole, is fused. Reads the whole, changes nothing of it; threads may do so at
/// once.
[[nodiscard]] PartFusions fusePart(const FusionState& whole, const FusionFrame& frame,
                                   const FusionOptions& options, std::span<const CellId> cells,
                                   std::span<const std::uint8_t> isSeam, const PartEnd& end,
                                   PartNumbers& numbers);

}  // namespace qtet
