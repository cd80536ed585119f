#include "simplify/fuse/band_nodes.h"

#include <algorithm>
#include <cassert>

#include "simplify/fuse/kd_tree.h"

namespace qtet {

BandNodes::BandNodes(const FusionMesh& mesh, const LatticeMesh& lattice,
                     std::size_t cellsPerPacket) {
  assert(mesh.vertexSlots() == lattice.points.size());
  bands_.depth = kdDepth(lattice.tetrahedra.size(), cellsPerPacket);
  if (bands_.depth == 0) return;
  bands_.leaf = kdLeaves(lattice.points, lattice.tetrahedra, bands_.depth);
  // A boundary triangle goes with the tetrahedron behind it. That one is in the star of each of its
  // vertices. The smallest star is searched: a vertex may be the hub of a wheel.
  for (const Triangle& t : lattice.boundary) {
    const VertexId least =
        *std::ranges::min_element(t, {}, [&](VertexId v) { return mesh.star(v).size(); });
    const auto behind = std::ranges::find_if(mesh.star(least), [&](CellId c) {
      const auto has = [&](VertexId v) {
        return std::ranges::find(mesh.cell(c), v) != mesh.cell(c).end();
      };
      return c < lattice.tetrahedra.size() && std::ranges::all_of(t, has);
    });
    bands_.leaf.push_back(bands_.leaf[*behind]);
  }
}

void BandNodes::begin(const FusionMesh& mesh) {
  assert(bands() < depth());
  const std::uint32_t depth = bands_.depth - bands();
  nodes_.assign(mesh.vertexSlots(), kBetween);
  for (VertexId v = 0; v < nodes_.size(); ++v) {
    if (!mesh.alive(v) || mesh.star(v).empty()) continue;
    nodes_[v] = bands_.node(mesh.star(v)[0], depth);
    for (const CellId c : mesh.star(v))
      if (bands_.node(c, depth) != nodes_[v]) {
        nodes_[v] = kBetween;
        break;
      }
  }
}

bool BandNodes::end(std::uint32_t firstLevel, std::uint32_t end) {
  nodes_.clear();
  if (end > firstLevel) bands_.ends.push_back(end);
  return end > firstLevel;
}

}  // namespace qtet
