#include "codec/mesh/face_groups.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace qtet {
namespace {

/// A cell's vertices, ascending, each with the number of its corner in the lowest two bits.
std::array<std::uint64_t, 4> ascending(const Tetrahedron& cell) {
  std::array<std::uint64_t, 4> out{};
  for (std::size_t i = 0; i < 4; ++i) out[i] = std::uint64_t{cell[i]} << 2 | i;
  const auto order = [&out](std::size_t a, std::size_t b) {
    const std::uint64_t low = std::min(out[a], out[b]), high = std::max(out[a], out[b]);
    out[a] = low, out[b] = high;
  };
  order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
  return out;
}

/// By vertex, how many faces have a smaller one as their smallest.
std::vector<std::uint64_t> bucketStarts(std::span<const Tetrahedron> tetrahedra) {
  VertexId largest = 0;
  for (const Tetrahedron& cell : tetrahedra)
    largest = std::max({largest, cell[0], cell[1], cell[2], cell[3]});
  std::vector<std::uint64_t> begin(std::size_t{largest} + 1, 0);
  for (const Tetrahedron& cell : tetrahedra) {
    const auto [lowA, highA] = std::minmax(cell[0], cell[1]);
    const auto [lowB, highB] = std::minmax(cell[2], cell[3]);
    begin[std::min(lowA, lowB)] += 3;
    begin[std::min({std::max(lowA, lowB), highA, highB})] += 1;
  }
  std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), std::uint64_t{0});
  return begin;
}

// Cells or vertices between two looks at whether to stop.
constexpr std::size_t kLookEvery = 4096;

}  // namespace

FaceGroups::FaceGroups(std::span<const Tetrahedron> tetrahedra, const std::atomic<bool>* stopped)
    : faces_(tetrahedra.size() * 4) {
  if (tetrahedra.empty()) return;
  const auto isStopped = [stopped](std::size_t at) {
    return at % kLookEvery == 0 && stopped != nullptr && *stopped;
  };
  // A counting sort by the smallest vertex first: what is left to compare are some twenty faces a
  // bucket.
  ends_ = bucketStarts(tetrahedra);
  for (std::size_t cell = 0; cell < tetrahedra.size(); ++cell) {
    if (isStopped(cell)) break;
    const std::array<std::uint64_t, 4> at = ascending(tetrahedra[cell]);
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t opposite) {
      faces_[ends_[at[a] >> 2]++] = {at[b] >> 2 << 32 | at[c] >> 2,
                                     4 * std::uint64_t{cell} + (at[opposite] & 3)};
    };
    add(0, 1, 2, 3), add(0, 1, 3, 2), add(0, 2, 3, 1), add(1, 2, 3, 0);
  }
  std::size_t first = 0;
  for (std::size_t v = 0; v < ends_.size(); ++v) {
    if (isStopped(v)) break;
    std::sort(faces_.begin() + static_cast<std::ptrdiff_t>(first),
              faces_.begin() + static_cast<std::ptrdiff_t>(ends_[v]));
    first = ends_[v];
  }
  if (stopped != nullptr && *stopped) faces_.clear(), ends_.clear();
}

}  // namespace qtet
