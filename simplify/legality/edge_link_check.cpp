#include "simplify/legality/edge_link_check.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>

namespace qtet {
namespace {

using Mask = std::uint64_t;  // of vertices of the ring
static_assert(kMaxRing == 64);

struct RingVertex {
  Mask own;     // its bit; none where it is not on the ring
  Mask joined;  // its neighbours on the ring
  // the ring's other vertices that it has an edge to in the link of either prey vertex
  std::array<Mask, 2> chords;
};

bool hasTwo(Mask mask) {
  const Mask allButOne = mask & (mask - 1);
  return allButOne != 0 && (allButOne & (allButOne - 1)) == 0;
}

// An edge between two vertices of the ring that is in both links but not in the ring. Each link is
// closed, so that it has every edge in both directions.
bool hasCommonChord(const LocalStar& star, std::span<RingVertex> vertices) {
  for (const auto& t : star.turned())
    for (std::size_t e = 0; e < 3; ++e) {
      assert(t[e] < vertices.size() && t[3] < 2);
      RingVertex& from = vertices[t[e]];
      from.chords[t[3]] |= vertices[t[(e + 1) % 3]].own & ~from.joined;
    }
  Mask inBoth = 0;
  for (const RingVertex& v : vertices) inBoth |= v.chords[0] & v.chords[1];
  return inBoth != 0;
}

// A triangle that fills a ring of three in both.
bool hasCommonTriangle(const LocalStar& star, std::span<const RingVertex> vertices) {
  unsigned filled = 0;
  for (const auto& t : star.turned()) {
    const Mask corners = vertices[t[0]].own | vertices[t[1]].own | vertices[t[2]].own;
    filled |= unsigned{corners == 7} << t[3];
  }
  return filled == 3;
}

}  // namespace

// The link condition of Dey, Edelsbrunner, Guha and Nekhayev, in the complex completed by the
// ghost. It says that the links of the two vertices meet in the edge's link and nowhere else. That
// link is one cycle, since neither vertex is singular.
bool edgeKeepsTopology(const LocalStar& star) {
  const auto ring = star.ring();
  assert(star.prey().k == 2 && ring.size() <= kMaxRing);
  std::array<RingVertex, LocalVertices::kMax> room;
  assert(star.vertices().size() <= room.size());
  assert(star.ofFirst().affected <= star.turned().size());
  assert(star.ofFirst().vertices <= star.vertices().size());
  const std::span<RingVertex> vertices = std::span(room).first(star.vertices().size());
  std::ranges::fill(vertices, RingVertex{});
  for (const auto& t : star.turned().subspan(star.ofFirst().affected))
    for (std::size_t j = 0; j < 3; ++j) vertices[t[j]].own = 1;
  for (const auto& [x, y] : ring) vertices[x].own = vertices[y].own = 1;
  std::size_t common = 0;
  for (RingVertex& v : vertices.first(star.ofFirst().vertices)) {
    const Mask isCommon = v.own;
    v.own = isCommon << (common % kMaxRing);
    common += isCommon;
  }
  for (RingVertex& v : vertices.subspan(star.ofFirst().vertices)) v.own = 0;
  if (common != ring.size()) return false;
  for (const auto& [x, y] : ring) {
    vertices[x].joined |= vertices[y].own;
    vertices[y].joined |= vertices[x].own;
  }
  for (const auto& [x, y] : ring)
    if (!hasTwo(vertices[x].joined) || !hasTwo(vertices[y].joined)) return false;
  return !hasCommonChord(star, vertices) && !(common == 3 && hasCommonTriangle(star, vertices));
}

}  // namespace qtet
