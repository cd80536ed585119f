// One vertex and the star round it, as the codec's parts see it: for tests that need a link and no
// whole mesh.
#pragma once

#include <map>
#include <span>
#include <stdexcept>
#include <vector>

#include "codec/mesh/boundary.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/mesh/link.h"

namespace qtet::testing {

struct StarMesh {
  GrowingMesh mesh;  ///< vertex 0 is the centre; level 1 has begun
  Link link;         ///< of vertex 0, placed
};

/// The star of an octahedron's centre. The corners lie 2 * `scale` away on the axes, and each face
/// is cut in four. This gives 32 cells round an inner vertex. `half` keeps the upper half only: 16
/// cells, and 8 boundary triangles round a vertex on the boundary. REQUIRES: every corner within
/// [0, 2^bits).
[[nodiscard]] inline StarMesh starMesh(const LatticePoint& centre, const LatticePoint& scale,
                                       int bits, bool half = false) {
  StarMesh out;
  out.mesh.points.push_back(centre);
  std::map<LatticePoint, VertexId> ids;
  const auto corner = [&](const LatticePoint& at) {
    const auto [found, fresh] = ids.try_emplace(at, static_cast<VertexId>(out.mesh.points.size()));
    if (fresh)
      out.mesh.points.push_back({centre[0] + scale[0] * at[0], centre[1] + scale[1] * at[1],
                                 centre[2] + scale[2] * at[2]});
    return found->second;
  };
  for (int octant = 0; octant < (half ? 4 : 8); ++octant) {
    const std::int32_t x = octant & 1 ? -1 : 1, y = octant & 2 ? -1 : 1, z = octant & 4 ? -1 : 1;
    const std::array<VertexId, 6> v{corner({2 * x, 0, 0}), corner({0, 2 * y, 0}),
                                    corner({0, 0, 2 * z}), corner({x, y, 0}),
                                    corner({0, y, z}),     corner({x, 0, z})};
    for (const auto& [a, b, c] :
         {std::array{0, 5, 3}, std::array{3, 4, 1}, std::array{5, 2, 4}, std::array{3, 5, 4}}) {
      const auto at = [&](int i) { return v[static_cast<std::size_t>(i)]; };
      out.mesh.tetrahedra.push_back(x * y * z > 0 ? Tetrahedron{at(a), at(b), at(c), 0}
                                                  : Tetrahedron{at(a), at(c), at(b), 0});
    }
  }
  out.mesh.boundary = boundaryOf(out.mesh.tetrahedra);
  out.mesh.start(bits);
  out.mesh.beginLevel(1);
  if (!out.mesh.enter(0, out.link)) throw std::logic_error("the star's link is no sphere");
  return out;
}

/// Gives the link's triangles these labels and no others; without any, takes theirs away.
inline void labelAs(StarMesh& star, std::span<const std::uint8_t> labels) {
  if (!star.mesh.enter(0, star.link)) throw std::logic_error("the star's link is no sphere");
  for (std::uint32_t f = 0; f < labels.size(); ++f) star.link.label(f, labels[f]);
}

[[nodiscard]] inline std::vector<std::uint8_t> labelsOf(const Link& link) {
  std::vector<std::uint8_t> out;
  for (const LinkTriangle& t : link.triangles()) out.push_back(t.label);
  return out;
}

/// Gives each triangle of the link the nearest of `prey`, and renumbers these in order of first
/// appearance along the traversal, as records do. Returns how many have triangles: the first of
/// `prey`, which is put into the same order.
inline std::size_t labelByNearest(StarMesh& star, std::vector<LatticePoint>& prey) {
  std::vector<LatticePoint> ordered;
  std::vector<std::uint8_t> labels(star.link.triangles().size());
  for (const std::uint32_t f : star.link.traversal()) {
    const auto& middle = star.link.middles()[f].place;
    const auto distance = [&](const LatticePoint& p) {
      double squared = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const double d = 6.0 * (p[a] - star.mesh.points[0][a]) - middle[a];
        squared += d * d;
      }
      return squared;
    };
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < prey.size(); ++i)
      if (distance(prey[i]) < distance(prey[nearest])) nearest = i;
    std::size_t label = 0;
    while (label < ordered.size() && ordered[label] != prey[nearest]) ++label;
    if (label == ordered.size()) ordered.push_back(prey[nearest]);
    labels[f] = static_cast<std::uint8_t>(label);
  }
  labelAs(star, labels);
  const std::size_t seen = ordered.size();
  for (const LatticePoint& p : prey) {
    bool known = false;
    for (const LatticePoint& q : ordered) known |= p == q;
    if (!known) ordered.push_back(p);
  }
  prey = ordered;
  return seen;
}

}  // namespace qtet::testing
