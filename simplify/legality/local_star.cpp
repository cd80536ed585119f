#include "simplify/legality/local_star.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "codec/mesh/growing_mesh.h"

namespace qtet {

bool LocalStar::gather(const Prey& prey) {
  assert(prey.k >= 2 && prey.k <= 4);
  assert(starCellsOf(mesh_, prey) <= kMaxStarCells);
  prey_ = prey;
  for (const VertexId v : prey.vertices()) mesh_.prefetchStar(v);
  star_.affected.clear(), star_.deleted.clear(), star_.labels.clear(), star_.link.clear();
  inner_.clear(), innerDeleted_.clear();
  vertices_.clear();
  for (const VertexId v : prey.vertices()) (void)vertices_.intern(v);
  if (prey.k == 2 ? !addStars<2>() : prey.k == 3 ? !addStars<3>() : !addStars<4>()) return false;
  if (star_.affected.size() > kMaxStarCells / 2) return false;
  assert(star_.labels.size() == star_.affected.size());
  assert(vertices_.ids().size() >= prey.k);
  star_.link.assign(vertices_.ids().begin() + prey.k, vertices_.ids().end());
  return true;
}

// The cells of each prey vertex' star, unless an earlier one's had it. False: one of them rules the
// fusion out.
template <std::uint32_t k>
bool LocalStar::addStars() {
  ByCell<CellId> staying, going;  // of one prey vertex
  for (std::uint32_t i = 0; i < k; ++i) {
    const std::uint32_t own = 1u << i;
    const std::size_t before = star_.affected.size(), known = vertices_.ids().size();
    if (k == 2 && i == 1) ofFirst_ = {known, before};
    std::size_t stayingCount = 0, goingCount = 0;
    // parted first, since a processor cannot foresee which it is
    for (const CellId c : mesh_.star(prey_.vertex[i])) {
      const std::uint32_t side = sideOf<k>(mesh_, prey_, c);
      staying[stayingCount] = going[goingCount] = c;
      stayingCount += side == own;
      goingCount += unsigned{side > own} & unsigned{(side & (own - 1)) == 0};
    }
    star_.affected.insert(star_.affected.end(), staying.begin(),
                          staying.begin() + static_cast<std::ptrdiff_t>(stayingCount));
    assert(stayingCount + goingCount <= mesh_.star(prey_.vertex[i]).size());
    star_.labels.resize(before + stayingCount, static_cast<std::uint8_t>(i));
    std::size_t ghosts = 0;  // come first in every star
    while (ghosts < stayingCount && mesh_.isGhost(staying[ghosts])) ++ghosts;
    for (std::size_t at = before + ghosts; at < before + stayingCount; ++at)
      inner_.add(static_cast<std::uint32_t>(at));
    addAffected(before, i);
    if (!addDeleted<k>(std::span(going).first(goingCount))) return false;
    for (const VertexId v : vertices_.ids().subspan(known))
      if (v != kGhost) mesh_.prefetchPoint(v);
  }
  return true;
}

// The affected cells of prey vertex `from`, which begin at `before`.
inline void LocalStar::addAffected(std::size_t before, std::uint32_t from) {
  const VertexId v = prey_.vertex[from];
  LocalVertices::Adding adding(vertices_);
  auto* local = &turned_[before];
  for (const CellId c : std::span(star_.affected).subspan(before)) {
    assert(mesh_.isLive(c) && mesh_.holds(c, v));
    const auto& cell = mesh_.cell(c);
    const auto turned = withLast(cell, onlyCorner(cornersThatAre(cell, v)));
    const Local x = adding.intern(turned[0]), y = adding.intern(turned[1]),
                z = adding.intern(turned[2]);
    *local++ = {x, y, z, from};
  }
}

// More than one of their vertices is prey.
template <std::uint32_t k>
inline bool LocalStar::addDeleted(std::span<const CellId> cells) {
  std::size_t maxSingular = 0;
  LocalVertices::Adding adding(vertices_);
  for (std::size_t at = 0; at < cells.size(); ++at) {
    const auto& cell = mesh_.cell(cells[at]);
    // by corner, and one place for prey vertices that the cell does not have
    std::array<Local, 5> local{};
    unsigned prey = 0;
    for (std::uint32_t i = 0; i < k; ++i) {
      const unsigned corner = cornersThatAre(cell, prey_.vertex[i]);
      local[corner == 0 ? 4 : onlyCorner(corner)] = i;
      prey |= corner;
    }
    assert(std::popcount(prey) >= 2);
    const OtherCorners& others = kOtherCorners[prey];
    std::array<Local, 2> other{};
    std::size_t singular = 0;
    for (std::size_t i = 0; i < (k == 2 ? 2 : others.count); ++i) {
      const std::size_t j = others.corner[i];
      local[j] = other[i] = adding.intern(cell[j]);
      singular += cell[j] != kGhost && mesh_.singular(cell[j]);
    }
    maxSingular = std::max(maxSingular, singular);
    if (k == 2) ring_[at] = other;
    assert(mesh_.isLive(cells[at]));
    innerDeleted_.addIf(!mesh_.isGhost(cells[at]), {local[0], local[1], local[2], local[3]});
  }
  star_.deleted.insert(star_.deleted.end(), cells.begin(), cells.end());
  return maxSingular <= 1;  // else an edge that is not a manifold's could be fused away unseen
}

}  // namespace qtet
