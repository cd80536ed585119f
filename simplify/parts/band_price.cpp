#include "simplify/parts/band_price.h"

#include <algorithm>
#include <cassert>

namespace qtet {

std::vector<LevelOfPart> levelsInOrder(std::span<const std::vector<PartLevel>> parts) {
  std::vector<LevelOfPart> out;
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    float key = 0;
    for (std::uint32_t l = 0; l < parts[p].size(); ++l) {
      key = std::max(key, parts[p][l].key);
      out.push_back({key, p, l, parts[p][l].removed});
    }
  }
  std::ranges::sort(out);
  return out;
}

double shareLeft(double share, double inner) {
  assert(inner >= 0 && inner <= 1);
  return 1 - (1 - share) * std::max(0.0, 1 - 2 * (1 - inner));
}

float keyAt(std::span<const std::vector<PartLevel>> sampled, std::size_t cells, double share) {
  const double most = share * static_cast<double>(cells);
  float key = 0;
  for (const LevelOfPart& level : levelsInOrder(sampled)) {
    if (static_cast<double>(cells) <= most) break;
    assert(level.removed <= cells);
    cells -= level.removed;
    key = level.key;
  }
  return key;
}

}  // namespace qtet
