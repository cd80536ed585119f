#include "codec/mesh/face_groups.h"

#include <algorithm>
#include <tuple>

#include "codec/mesh/boundary.h"

namespace qtet {
namespace {

Triangle sorted(Triangle t) {
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  if (t[1] > t[2]) std::swap(t[1], t[2]);
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  return t;
}

/// `begin[v]`: how many faces have a smallest vertex below v.
std::vector<std::uint64_t> bucketStarts(std::span<const Tetrahedron> tetrahedra) {
  VertexId largest = 0;
  for (const Tetrahedron& cell : tetrahedra)
    largest = std::max({largest, cell[0], cell[1], cell[2], cell[3]});
  std::vector<std::uint64_t> begin(std::size_t{largest} + 2, 0);
  for (const Tetrahedron& cell : tetrahedra) {
    for (int i = 0; i < 4; ++i) ++begin[std::size_t{sorted(cellFace(cell, i))[0]} + 1];
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
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
  const std::vector<std::uint64_t> begin = bucketStarts(tetrahedra);
  std::vector<std::uint64_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t cell = 0; cell < tetrahedra.size(); ++cell) {
    if (isStopped(cell)) break;
    for (int i = 0; i < 4; ++i) {
      const Triangle face = sorted(cellFace(tetrahedra[cell], i));
      faces_[next[face[0]]++] = {face[0], face[1], face[2],
                                 4 * std::uint64_t{cell} + static_cast<std::uint64_t>(i)};
    }
  }
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    if (isStopped(v)) break;
    std::sort(faces_.begin() + static_cast<std::ptrdiff_t>(begin[v]),
              faces_.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]),
              [](const Face& a, const Face& b) {
                return std::tie(a.middle, a.largest, a.side) <
                       std::tie(b.middle, b.largest, b.side);
              });
  }
  if (stopped != nullptr && *stopped) faces_.clear();
}

}  // namespace qtet
