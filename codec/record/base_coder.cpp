#include "codec/record/base_coder.h"

namespace qtet {

BaseTruth::BaseTruth(std::span<const Tetrahedron> cells) : cells_(cells), placed_(cells.size(), 0) {
  faces_.reserve(cells.size() * 4);
  for (std::uint32_t i = 0; i < cells.size(); ++i)
    for (int f = 0; f < 4; ++f) faces_.emplace_back(sortedFace(cellFace(cells[i], f)), i);
  std::ranges::sort(faces_);
}

std::uint32_t BaseTruth::unplacedAt(const Triangle& face) const {
  const Triangle key = sortedFace(face);
  for (auto at = std::ranges::lower_bound(faces_, std::pair{key, 0u});
       at != faces_.end() && at->first == key; ++at)
    if (!placed_[at->second]) return at->second;
  return kNone;
}

std::uint32_t BaseTruth::nextSeed() {
  while (placed_[seed_]) ++seed_;
  return seed_;
}

}  // namespace qtet
