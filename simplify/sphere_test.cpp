#include "simplify/sphere_test.h"

#include <algorithm>
#include <bit>

#include "codec/boundary.h"

namespace qtet {

bool SphereTest::isLinkSphere(VertexId v, std::span<const CellId> star, std::span<const Tetrahedron> cells) {
  const std::size_t triangles = star.size();
  // A sphere has two vertices more than half its triangles.
  if (triangles < 4 || triangles % 2 != 0) return false;
  if (triangles / 2 + 2 > kMost) return askLink(v, star, cells);
  ++asked_;
  std::uint32_t count = 0;
  const auto number = [&](VertexId w) {
    Local& local = locals_[w == kGhost ? locals_.size() - 1 : w];
    if (local.asked != asked_) {
      local = {asked_, count};
      if (count < kMost) to_[count] = from_[count] = walked_[count] = 0;
      ++count;
    }
    return local.number;
  };
  for (const CellId c : star) {
    const Tetrahedron& cell = cells[c];
    const auto& corner = kCellFaces[cell[0] == v ? 0 : cell[1] == v ? 1 : cell[2] == v ? 2 : 3];
    std::array<std::uint32_t, 3> t{};
    for (std::size_t i = 0; i < 3; ++i) t[i] = number(cell[static_cast<std::size_t>(corner[i])]);
    if (count > triangles / 2 + 2) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      to_[a] |= Mask{1} << b;
      from_[b] |= Mask{1} << a;
      third_[kMost * a + b] = static_cast<Small>(t[(i + 2) % 3]);
    }
  }
  return count == triangles / 2 + 2 && isClosed(count, triangles) && isConnected(triangles);
}

// An edge that is there twice in one direction leaves too few.
bool SphereTest::isClosed(std::uint32_t vertices, std::size_t triangles) const {
  std::size_t edges = 0;
  for (std::uint32_t a = 0; a < vertices; ++a) {
    if (to_[a] != from_[a]) return false;
    edges += static_cast<std::size_t>(std::popcount(to_[a]));
  }
  return edges == 3 * triangles;
}

// From triangle to triangle across edges. REQUIRES: closed.
bool SphereTest::isConnected(std::size_t triangles) {
  std::size_t waiting = 0, reached = 0;
  const auto push = [&](Small a, Small b) { walk_[waiting++] = {a, b}; };
  const auto first = static_cast<Small>(std::countr_zero(to_[0]));
  push(first, 0), push(0, first);
  while (waiting > 0) {
    const auto [a, b] = walk_[--waiting];
    if ((walked_[a] >> b & 1) != 0) continue;
    const Small c = third_[kMost * a + b];
    walked_[a] |= Mask{1} << b, walked_[b] |= Mask{1} << c, walked_[c] |= Mask{1} << a;
    push(c, b), push(a, c);
    ++reached;
  }
  return reached == triangles;
}

bool SphereTest::askLink(VertexId v, std::span<const CellId> star, std::span<const Tetrahedron> cells) {
  link_.clear(locals_.size() - 1);
  for (const CellId c : star) {
    const auto at = static_cast<std::size_t>(std::ranges::find(cells[c], v) - cells[c].begin());
    const auto& corner = kCellFaces[at];
    const auto of = [&](std::size_t i) { return cells[c][static_cast<std::size_t>(corner[i])]; };
    link_.add(of(0), of(1), of(2));
  }
  return link_.close() && link_.isSphere();
}

}  // namespace qtet
