#include "simplify/blocks/shared_vertices.h"

#include <algorithm>
#include <iterator>

namespace qtet {

void SharedVertices::add(std::uint32_t block, std::span<const WholeVertex> vertices,
                         std::span<const WholeVertex> mayBe) {
  std::vector<WholeVertex> both;
  std::ranges::set_intersection(vertices, mayBe, std::back_inserter(both));
  const std::lock_guard lock(mutex_);
  for (const WholeVertex v : both) blockOf_.emplace_back(v, block);
}

std::vector<std::vector<WholeVertex>> SharedVertices::take(std::uint32_t blocks) {
  std::ranges::sort(blockOf_);
  const auto same = std::ranges::unique(blockOf_);
  blockOf_.erase(same.begin(), same.end());
  std::vector<std::vector<WholeVertex>> out(blocks);
  for (auto first = blockOf_.begin(); first != blockOf_.end();) {
    const auto end = std::find_if(first, blockOf_.end(),
                                  [&](const auto& entry) { return entry.first != first->first; });
    for (auto at = first; end - first > 1 && at != end; ++at) out[at->second].push_back(at->first);
    first = end;
  }
  blockOf_ = {};
  return out;
}

}  // namespace qtet
