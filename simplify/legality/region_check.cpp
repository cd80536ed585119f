#include "simplify/legality/region_check.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace qtet {
namespace {

constexpr VertexId kNoVertex = kGhost - 1;

}  // namespace

// After the fusion each region of the star is the cone from the fused vertex over its triangles of
// the link. Any regions that the star holds meet in the cone over what they share there. All of
// these are contractible. The star is replaced by something of the same topology, region by region,
// on two conditions. The same holds before: any regions that the star holds meet in one
// contractible set. Nothing changes on the link: no region touches it but where it has
// triangles there.
bool RegionCheck::passes(const FusionMesh& mesh, const Prey& prey, const Star& star) {
  assert(mesh.hasRegions());
  regions_.clear();
  simplices_.clear();
  for (const CellId c : star.affected)
    if (!addCell(mesh, prey, c, true)) return false;
  const std::size_t onLink = regions_.size();
  for (const CellId c : star.deleted)
    if (!addCell(mesh, prey, c, false) || regions_.size() > onLink) return false;
  if (onLink == 1) return true;
  assert(!simplices_.empty() && onLink <= kMaxRegions);
  merge();
  for (const Simplex& s : simplices_)
    if (s.ofLink != 0 && s.ofLink != s.regions) return false;
  for (unsigned regions = 1; regions < 1u << onLink; ++regions)
    if (!isContractible(static_cast<Mask>(regions))) return false;
  return true;
}

// The cell with all its faces, edges and vertices. The outside counts as a region; the ghost is no
// vertex of it.
bool RegionCheck::addCell(const FusionMesh& mesh, const Prey& prey, CellId c, bool affected) {
  const std::int64_t region = mesh.region(c);
  const auto at = static_cast<std::size_t>(std::ranges::find(regions_, region) - regions_.begin());
  if (at == kMaxRegions) return false;
  if (at == regions_.size()) regions_.push_back(region);
  std::array<VertexId, 4> cell = mesh.cell(c);
  std::ranges::sort(cell);  // kGhost last
  assert((cell[3] == kGhost) == (region == FusionMesh::kOutside));
  const unsigned corners = cell[3] == kGhost ? 3 : 4;
  for (unsigned subset = 1; subset < 1u << corners; ++subset) {
    Simplex s{{kNoVertex, kNoVertex, kNoVertex, kNoVertex}, 0, static_cast<Mask>(1u << at), 0};
    bool onLink = affected;
    for (unsigned i = 0; i < corners; ++i)
      if (subset >> i & 1u) {
        s.vertex[s.size++] = cell[i];
        onLink &= std::ranges::find(prey.vertices(), cell[i]) == prey.vertices().end();
      }
    if (onLink) s.ofLink = s.regions;
    simplices_.push_back(s);
  }
  return true;
}

void RegionCheck::merge() {
  std::sort(simplices_.begin(), simplices_.end(),
            [](const Simplex& a, const Simplex& b) { return a.vertex < b.vertex; });
  std::size_t n = 0;
  for (const Simplex& s : simplices_) {
    if (n > 0 && simplices_[n - 1].vertex == s.vertex)
      simplices_[n - 1].regions |= s.regions, simplices_[n - 1].ofLink |= s.ofLink;
    else
      simplices_[n++] = s;
  }
  simplices_.resize(n);
}

std::uint32_t RegionCheck::root(std::uint32_t i) {
  while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
  return i;
}

// Whether the subcomplex of the star that all these regions share is contractible: not empty,
// connected, Euler characteristic 1. In a ball that leaves no room for a hole and a void that
// cancel out, unless the regions themselves have them. Each region is looked at alone, too.
bool RegionCheck::isContractible(Mask regions) {
  int characteristic = 0;
  corners_.clear();
  for (const Simplex& s : simplices_) {
    if ((s.regions & regions) != regions) continue;
    characteristic += s.size % 2 == 1 ? 1 : -1;
    if (s.size == 1) corners_.push_back(s.vertex[0]);
  }
  if (characteristic != 1) return false;
  assert(!corners_.empty() && std::ranges::is_sorted(corners_));
  parent_.resize(corners_.size());
  std::iota(parent_.begin(), parent_.end(), 0u);
  std::size_t parts = corners_.size();
  const auto local = [&](VertexId v) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(corners_, v) - corners_.begin());
  };
  for (const Simplex& s : simplices_) {
    if (s.size != 2 || (s.regions & regions) != regions) continue;
    assert(local(s.vertex[0]) < corners_.size() && local(s.vertex[1]) < corners_.size());
    const std::uint32_t a = root(local(s.vertex[0])), b = root(local(s.vertex[1]));
    if (a != b) parent_[a] = b, --parts;
  }
  return parts == 1;
}

}  // namespace qtet
