#include "simplify/fuse/sphere_check.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "codec/mesh/boundary.h"
#include "simplify/fuse/cell_corners.h"

namespace qtet {

bool SphereCheck::isLinkSphere(VertexId v, std::span<const CellId> star,
                               std::span<const Tetrahedron> cells) {
  const std::size_t triangles = star.size();
  // A sphere has two vertices more than half its triangles.
  if (triangles < 4 || triangles % 2 != 0) return false;
  if (triangles / 2 + 2 > kMax) return askLink(v, star, cells);
  const std::size_t vertices = triangles / 2 + 2;
  std::fill_n(to_.begin(), vertices, 0), std::fill_n(from_.begin(), vertices, 0);
  if (base_ > std::numeric_limits<std::uint32_t>::max() - 2 * kMaxNumbers)
    std::ranges::fill(numbers_, base_ = 0);
  base_ += kMaxNumbers;
  std::uint32_t count = 0;
  // Whether the vertex is new is no branch: a processor could not foresee it.
  const auto number = [&](VertexId w) {
    std::uint32_t& known = numbers_[w == kGhost ? numbers_.size() - 1 : w];
    const std::uint32_t local = std::min(known - base_, count);
    known = base_ + local;
    count += local == count;
    return local;
  };
  for (const CellId c : star) {
    const Tetrahedron& cell = cells[c];
    const auto& corner = kCellFaces[onlyCorner(cornersThatAre(cell, v))];
    std::array<std::uint32_t, 3> t{};
    for (std::size_t i = 0; i < 3; ++i) t[i] = number(cell[static_cast<std::size_t>(corner[i])]);
    if (count > vertices) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      to_[a] |= Mask{1} << b;
      from_[b] |= Mask{1} << a;
      third_[kMax * a + b] = static_cast<Small>(t[(i + 2) % 3]);
    }
  }
  return count == vertices && isClosed(count, triangles) &&
         (isSurelyConnected(count) || isConnected(triangles));
}

// An edge that is there twice in one direction leaves too few.
bool SphereCheck::isClosed(std::uint32_t vertices, std::size_t triangles) {
  std::size_t edges = 0;
  Mask open = 0;
  simple_ = 0;
  for (std::uint32_t a = 0; a < vertices; ++a) {
    const auto own = static_cast<std::size_t>(std::popcount(to_[a]));
    open |= to_[a] ^ from_[a];
    edges += own;
    simple_ |= Mask{own < 6} << a;
  }
  return open == 0 && edges == 3 * triangles;
}

// From vertex to vertex, but on from those alone whose triangles are one fan, for two would be six
// triangles. So this stays within triangles that hang together by edges. Where it reaches all V
// vertices these are 2 V - 4 triangles at least, by Euler, for their characteristic is at most 2
// and a vertex where several fans of theirs meet only adds to them; since F = 2 V - 4 there are no
// others. False says nothing. REQUIRES: closed, V = F / 2 + 2.
bool SphereCheck::isSurelyConnected(std::uint32_t vertices) const {
  Mask reached = simple_ & (~simple_ + 1), waiting = reached;
  while (waiting != 0) {
    const Mask more = to_[static_cast<std::size_t>(std::countr_zero(waiting))] & ~reached;
    reached |= more;
    waiting = (waiting & (waiting - 1)) | (more & simple_);
  }
  return static_cast<std::uint32_t>(std::popcount(reached)) == vertices;
}

// From triangle to triangle across edges. REQUIRES: closed.
bool SphereCheck::isConnected(std::size_t triangles) {
  walked_.fill(0);
  std::size_t waiting = 0, reached = 0;
  const auto push = [&](Small a, Small b) { walk_[waiting++] = {a, b}; };
  const auto first = static_cast<Small>(std::countr_zero(to_[0]));
  push(first, 0), push(0, first);
  while (waiting > 0) {
    const auto [a, b] = walk_[--waiting];
    if ((walked_[a] >> b & 1) != 0) continue;
    const Small c = third_[kMax * a + b];
    walked_[a] |= Mask{1} << b, walked_[b] |= Mask{1} << c, walked_[c] |= Mask{1} << a;
    push(c, b), push(a, c);
    ++reached;
  }
  return reached == triangles;
}

bool SphereCheck::askLink(VertexId v, std::span<const CellId> star,
                          std::span<const Tetrahedron> cells) {
  link_.clear(numbers_.size() - 1);
  for (const CellId c : star) {
    const auto at = static_cast<std::size_t>(std::ranges::find(cells[c], v) - cells[c].begin());
    const auto& corner = kCellFaces[at];
    const auto of = [&](std::size_t i) { return cells[c][static_cast<std::size_t>(corner[i])]; };
    link_.add(of(0), of(1), of(2));
  }
  return link_.close() && link_.isSphere();
}

}  // namespace qtet
