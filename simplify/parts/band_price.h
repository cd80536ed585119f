// The price at which a band of fusions ends: what is cheap anywhere goes before what is dear
// (PARTS.md, "Bands").
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/fuse/fusion_loop.h"

namespace qtet {

/// A band ends at the price at which the whole mesh, without seams, would have one in so many of
/// its cells left. With 3, levels at a half of the cells have 1.3 to 1.7 times the error of one
/// piece. Dear cells inside of parts go before cheap ones at their seams.
inline constexpr double kBandFactor = 1.7;
/// All sampled parts together are asked down to a number of cells. Each goes on to this share of
/// its own, since what is cheap differs from part to part.
inline constexpr double kSampledTo = 0.5;

/// Cheap levels come first, those of a part in their order: by the largest key of it so far.
struct LevelOfPart {
  float key = 0;
  std::uint32_t part = 0, level = 0;
  std::size_t removed = 0;
  auto operator<=>(const LevelOfPart&) const = default;
};
[[nodiscard]] std::vector<LevelOfPart> levelsInOrder(std::span<const std::vector<PartLevel>> parts);

/// The share of the cells that parts keep where the whole, without seams, would keep `share`. It is
/// 1 - (1 - share) (1 - 2 (1 - inner)). `inner` is the share of the vertices that are no seam.
[[nodiscard]] double shareLeft(double share, double inner);

/// The key at which all of the sampled parts' cells are down to this share of them; their largest
/// if they never are.
[[nodiscard]] float keyAt(std::span<const std::vector<PartLevel>> sampled, std::size_t cells,
                          double share);

}  // namespace qtet
