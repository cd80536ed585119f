#include "simplify/fuse/kd_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace qtet {
namespace {

/// The depth of a tree at most: twice as many packets as leaves stay below kMaxChunks.
constexpr std::uint32_t kMaxDepth = 18;

/// Four times the barycentre, and whose it is.
struct Item {
  LatticePoint sum{};
  CellId cell = 0;
};

std::size_t longestAxis(std::span<const Item> items) {
  LatticePoint least = items[0].sum, most = items[0].sum;
  for (const Item& item : items)
    for (std::size_t a = 0; a < 3; ++a)
      least[a] = std::min(least[a], item.sum[a]), most[a] = std::max(most[a], item.sum[a]);
  std::size_t longest = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (most[a] - least[a] > most[longest] - least[longest]) longest = a;
  return longest;
}

// At most kMaxDepth calls deep.
void split(std::span<Item> items, std::uint32_t node, std::uint32_t depth,
           std::vector<std::uint32_t>& leaf) {
  if (depth == 0 || items.empty()) {
    for (const Item& item : items) leaf[item.cell] = node << depth;
    return;
  }
  const std::size_t axis = longestAxis(items);
  const auto before = [axis](const Item& a, const Item& b) {
    return a.sum[axis] != b.sum[axis] ? a.sum[axis] < b.sum[axis] : a.cell < b.cell;
  };
  const std::size_t half = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   before);
  split(items.first(half), 2 * node, depth - 1, leaf);
  split(items.subspan(half), 2 * node + 1, depth - 1, leaf);
}

}  // namespace

std::uint32_t kdDepth(std::size_t cells, std::size_t cellsPerLeaf) {
  assert(cellsPerLeaf > 0);
  std::uint32_t depth = 0;
  // Nearest in proportion: cells / 2^depth lies within a factor sqrt(2) of what was asked for.
  while (depth < kMaxDepth &&
         static_cast<double>(cells) / std::ldexp(1.0, static_cast<int>(depth)) >
             1.4142135623730951 * static_cast<double>(cellsPerLeaf))
    ++depth;
  return depth;
}

std::vector<std::uint32_t> kdLeaves(std::span<const LatticePoint> points,
                                    std::span<const Tetrahedron> tetrahedra, std::uint32_t depth) {
  assert(depth <= kMaxDepth);
  std::vector<Item> items(tetrahedra.size());
  for (CellId c = 0; c < tetrahedra.size(); ++c) {
    items[c].cell = c;
    for (const VertexId v : tetrahedra[c])
      for (std::size_t a = 0; a < 3; ++a) items[c].sum[a] += points[v][a];
  }
  std::vector<std::uint32_t> leaf(tetrahedra.size());
  split(items, 0, depth, leaf);
  return leaf;
}

}  // namespace qtet
