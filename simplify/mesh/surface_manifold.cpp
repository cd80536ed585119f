#include "simplify/mesh/surface_manifold.h"

#include <algorithm>
#include <compare>

namespace qtet {
namespace {

/// The edge of a triangle that lies opposite `vertex`, in the triangle's rotation.
struct Corner {
  VertexId vertex;
  VertexId from;
  VertexId to;

  auto operator<=>(const Corner&) const = default;
};

std::vector<Corner> cornersOf(std::span<const Triangle> surface) {
  std::vector<Corner> corners;
  corners.reserve(surface.size() * 3);
  for (const Triangle& t : surface) {
    corners.push_back({t[0], t[1], t[2]});
    corners.push_back({t[1], t[2], t[0]});
    corners.push_back({t[2], t[0], t[1]});
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Whether the edges of one vertex's corners (sorted) form a single cycle.
bool isClosedFan(std::span<const Corner> corners) {
  std::size_t at = 0;
  for (std::size_t steps = 1; steps <= corners.size(); ++steps) {
    const VertexId next = corners[at].to;
    const auto found = std::lower_bound(corners.begin(), corners.end(), next,
                                        [](const Corner& c, VertexId v) { return c.from < v; });
    if (found == corners.end() || found->from != next) return false;
    at = static_cast<std::size_t>(found - corners.begin());
    if (at == 0) return steps == corners.size();
  }
  return false;
}

std::vector<std::array<VertexId, 2>> edgesNotOfTwo(std::span<const Triangle> surface) {
  std::vector<std::array<VertexId, 2>> all, out;
  all.reserve(surface.size() * 3);
  for (const Triangle& t : surface) {
    for (std::size_t i = 0; i < 3; ++i)
      all.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
  }
  std::sort(all.begin(), all.end());
  for (std::size_t first = 0; first < all.size();) {
    std::size_t end = first;
    while (end < all.size() && all[end] == all[first]) ++end;
    if (end - first != 2) out.push_back(all[first]);
    first = end;
  }
  return out;
}

}  // namespace

NonManifoldParts nonManifoldPartsOf(std::span<const Triangle> surface) {
  NonManifoldParts out{edgesNotOfTwo(surface), {}};
  const std::vector<Corner> corners = cornersOf(surface);
  for (std::size_t first = 0; first < corners.size();) {
    std::size_t end = first;
    while (end < corners.size() && corners[end].vertex == corners[first].vertex) ++end;
    if (!isClosedFan(std::span(corners).subspan(first, end - first)))
      out.vertices.push_back(corners[first].vertex);
    first = end;
  }
  return out;
}

}  // namespace qtet
