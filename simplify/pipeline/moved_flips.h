// The cells of a base mesh that are inside out where the mesh has moved.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "codec/record/fusion_history.h"

namespace qtet {

/// Over all instants of the field Displacement (moved_place.h).
struct MovedFlips {
  std::size_t instants = 0;  ///< 0: there is no such field
  std::size_t flipped = 0;   ///< instants with cells that are flat or inside out
  std::uint64_t cells = 0;   ///< these cells, at the instant that has most
  std::string worst{};       ///< the field of that instant

  /// Nothing where no cell is inside out.
  [[nodiscard]] std::optional<std::string> warning() const;
};

/// Counts in the cells that live. Cells that are flat or inside out at rest do not count. REQUIRES:
/// values without differences in time, none missing.
[[nodiscard]] MovedFlips movedFlips(const FusionHistory& history);

}  // namespace qtet
