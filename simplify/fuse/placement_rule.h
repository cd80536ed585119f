// The rule for which points a prey may be fused into.
#pragma once

#include <cstdint>

namespace qtet {

/// The points that are looked at. A free point takes twice the bits of one that follows from its
/// prey.
enum class PlacementRule : std::uint8_t {
  kOptimal,  ///< the quadric's minimum (Eq. 6-7), and what lies between it and the prey's middle
  kVertex,   ///< the prey vertices alone, which keeps every vertex of every level an original one
  /// Prey vertices, middle and quarters; a free point only where it adds less than a quarter of
  /// their error.
  kAuto,
};

}  // namespace qtet
