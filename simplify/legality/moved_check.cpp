#include "simplify/legality/moved_check.h"

#include <algorithm>
#include <cassert>

namespace qtet {

void MovedCheck::findPlaces() {
  for (const std::size_t f : fields_)
    for (const VertexId v : star_.vertices())
      places_.push_back(v == kGhost ? MovedPoint{}
                                    : movedPoint(mesh_.lattice(), mesh_.fields()[f], mesh_.point(v),
                                                 mesh_.values(f, v)));
}

bool MovedCheck::flipsAt(const LatticePoint& p, std::span<const std::int32_t> integers) {
  assert(integers.size() == 3 * fields_.size());
  assert(star_.vertices().size() >= star_.prey().k);
  if (places_.empty()) findPlaces();
  assert(places_.size() == fields_.size() * star_.vertices().size());
  const std::size_t vertices = star_.vertices().size();
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    const auto at = std::span(places_).subspan(i * vertices, vertices);
    const MovedPoint fused =
        movedPoint(mesh_.lattice(), mesh_.fields()[fields_[i]], p, integers.subspan(3 * i, 3));
    const auto flips = [&](std::uint32_t cell) {
      const auto& t = star_.turned()[cell];
      return movedOrientation(at[t[0]], at[t[1]], at[t[2]], fused) <= 0 &&
             movedOrientation(at[t[0]], at[t[1]], at[t[2]], at[t[3]]) > 0;
    };
    if (std::ranges::any_of(star_.inner(), flips)) return true;
  }
  return false;
}

}  // namespace qtet
