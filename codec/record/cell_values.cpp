#include "codec/record/cell_values.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "codec/mesh/face_groups.h"
#include "proto/limits.h"

namespace qtet {
namespace {

// A side packs three local vertices and a place among the split's tetrahedra into 64 bits. A link
// is a sphere of at most kMaxLinkTriangles, so it has half as many vertices and two; the prey's
// come above them.
constexpr int kLocalBits = 12;
constexpr std::uint64_t kFirstPrey = (1u << kLocalBits) - 4;
static_assert(kMaxLinkTriangles / 2 + 2 <= kFirstPrey);
constexpr int kTetrahedronBits = 64 - 3 * kLocalBits;
constexpr std::uint64_t kTetrahedronMask = (std::uint64_t{1} << kTetrahedronBits) - 1;

}  // namespace

void CellAncestry::add(CellId cell, CellId earlier) {
  *std::ranges::find(known_[cell], kNone) = earlier;
}

void CellAncestry::addBase(std::span<const Tetrahedron> tetrahedra) {
  assert(known_.empty());
  known_.assign(tetrahedra.size(), {kNone, kNone, kNone, kNone});
  FaceGroups(tetrahedra).forEach([this](std::span<const FaceSide> sides) {
    for (std::size_t i = 1; i < sides.size(); ++i) add(cellOf(sides[i]), cellOf(sides[i - 1]));
  });
  for (CellId cell = 1; cell < known_.size(); ++cell)
    if (known_[cell][0] == kNone) add(cell, cell - 1);
}

void CellAncestry::addSide(LocalVertex a, LocalVertex b, LocalVertex c, std::size_t tetrahedron) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  Side side = 0;
  for (const LocalVertex local : {a, b, c})
    side = side << kLocalBits | (local & kPreyBit ? kFirstPrey + (local & 3) : local);
  sides_.push_back(side << kTetrahedronBits | tetrahedron);
}

void CellAncestry::addRestored(std::span<const CellRef> star, const Link& link,
                               std::span<const LocalCell> restored, CellId first) {
  assert(star.size() == link.triangles().size() && first == known_.size());
  CellId next = first;
  sides_.clear();
  atSplit_.clear();
  const std::span<const LinkTriangle> triangles = link.triangles();
  for (std::size_t f = 0; f < star.size(); ++f) {
    if (star[f] & kBoundaryBit) continue;
    // A restored cell lies between two of the star only where their labels differ.
    for (std::size_t i = 0; i < 3; ++i)
      if (triangles[triangles[f].neighbour[i]].label != triangles[f].label)
        addSide(triangles[f].vertex[(i + 1) % 3], triangles[f].vertex[(i + 2) % 3],
                kPreyBit | triangles[f].label, atSplit_.size());
    atSplit_.push_back(star[f]);
  }
  for (const LocalCell& c : restored) {
    if (std::ranges::any_of(c, [&](LocalVertex local) {
          return !(local & kPreyBit) && link.vertices()[local] == kGhost;
        }))
      continue;
    for (std::size_t i = 0; i < 4; ++i)
      addSide(c[(i + 1) % 4], c[(i + 2) % 4], c[(i + 3) % 4], atSplit_.size());
    atSplit_.push_back(next++);
  }
  known_.resize(next, {kNone, kNone, kNone, kNone});
  std::sort(sides_.begin(), sides_.end());
  for (std::size_t i = 1; i < sides_.size(); ++i) {
    const CellId cell = atSplit_[sides_[i] & kTetrahedronMask];
    if (cell >= first && sides_[i] >> kTetrahedronBits == sides_[i - 1] >> kTetrahedronBits)
      add(cell, atSplit_[sides_[i - 1] & kTetrahedronMask]);
  }
}

std::int64_t CellAncestry::predictFrom(std::span<const std::int64_t> values) {
  if (values.empty()) return 0;
  constexpr std::int64_t kNoPair = std::numeric_limits<std::int64_t>::max();
  std::int64_t pair = kNoPair;
  for (std::size_t i = 1; i < values.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (values[i] == values[j]) pair = std::min(pair, values[i]);
  if (pair != kNoPair) return pair;
  return std::accumulate(values.begin(), values.end(), std::int64_t{0}) /
         static_cast<std::int64_t>(values.size());
}

}  // namespace qtet
