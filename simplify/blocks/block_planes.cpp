#include "simplify/blocks/block_planes.h"

#include <algorithm>
#include <cassert>

namespace qtet {
namespace {

std::size_t longestAxis(std::span<const CellMiddle> sample) {
  CellMiddle low = sample.front(), high = low, length{};
  for (const CellMiddle& middle : sample)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], middle[axis]);
      high[axis] = std::max(high[axis], middle[axis]);
    }
  for (std::size_t axis = 0; axis < 3; ++axis) length[axis] = high[axis] - low[axis];
  return static_cast<std::size_t>(std::ranges::max_element(length) - length.begin());
}

}  // namespace

BlockPlanes::BlockPlanes(std::vector<CellMiddle> sample, std::uint32_t count) {
  assert(count >= 1);
  cut(sample, count);
}

void BlockPlanes::cut(std::span<CellMiddle> sample, std::uint32_t count) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  if (count > 1 && sample.size() > 1) {
    const std::size_t axis = longestAxis(sample);
    const std::uint32_t first = count / 2;
    const auto at = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() * first / count);
    std::ranges::nth_element(sample, at, {}, [axis](const CellMiddle& m) { return m[axis]; });
    const std::uint32_t plane = (*at)[axis];
    const auto right = std::partition(sample.begin(), sample.end(),
                                      [&](const CellMiddle& m) { return m[axis] < plane; });
    if (right != sample.begin()) {
      nodes_[node].axis = static_cast<std::uint8_t>(axis), nodes_[node].at = plane;
      cut({sample.begin(), right}, first);
      nodes_[node].right = static_cast<std::uint32_t>(nodes_.size());
      cut({right, sample.end()}, count - first);
      return;
    }
  }
  nodes_[node].at = count_++;
}

std::uint32_t BlockPlanes::blockOf(const CellMiddle& middle) const {
  std::size_t at = 0;
  while (nodes_[at].right != 0)
    at = middle[nodes_[at].axis] < nodes_[at].at ? at + 1 : nodes_[at].right;
  return nodes_[at].at;
}

}  // namespace qtet
