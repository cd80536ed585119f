#include "codec/growing_mesh.h"

#include <algorithm>

namespace qtet {

void GrowingMesh::beginLevel() {
  marked_.assign(points.size(), 0);
  starOffsets_.assign(points.size() + 1, 0);
  for (const Tetrahedron& t : tetrahedra)
    for (const VertexId v : t) ++starOffsets_[v + 1];
  for (const Triangle& t : boundary)
    for (const VertexId v : t) ++starOffsets_[v + 1];
  for (std::size_t v = 0; v < points.size(); ++v) starOffsets_[v + 1] += starOffsets_[v];
  starCells_.resize(starOffsets_.back());
  // Fill by moving each start forward, then shift the starts back: no second array of cursors.
  for (std::uint32_t i = 0; i < tetrahedra.size(); ++i)
    for (const VertexId v : tetrahedra[i]) starCells_[starOffsets_[v]++] = i;
  for (std::uint32_t i = 0; i < boundary.size(); ++i)
    for (const VertexId v : boundary[i]) starCells_[starOffsets_[v]++] = i | kBoundaryBit;
  for (std::size_t v = points.size(); v > 0; --v) starOffsets_[v] = starOffsets_[v - 1];
  starOffsets_[0] = 0;
}

bool GrowingMesh::enter(VertexId v, Link& link) {
  link.clear(points.size());
  for (const CellRef ref : star(v)) {
    const std::array<VertexId, 4> vertices = cell(ref);
    const auto index = static_cast<std::size_t>(std::ranges::find(vertices, v) - vertices.begin());
    if (index == 4) return false;
    const std::array<VertexId, 4> turned = withLast(vertices, index);
    link.add(turned[0], turned[1], turned[2]);
    for (const VertexId w : vertices)
      if (w != kGhost) marked_[w] = 1;
  }
  return link.close() && link.isSphere();
}

void GrowingMesh::apply(VertexId v, const Link& link, const Split& split, std::uint16_t level) {
  std::array<VertexId, 4> prey{v};
  points[v] = split.points[0];
  born[v] = level;
  for (int i = 1; i < split.k; ++i) {
    prey[static_cast<std::size_t>(i)] = static_cast<VertexId>(points.size());
    points.push_back(split.points[static_cast<std::size_t>(i)]);
    born.push_back(level);
  }
  const std::span<const CellRef> cells = star(v);
  for (std::size_t f = 0; f < cells.size(); ++f) {
    const std::uint8_t label = link.triangles()[f].label;
    if (label == 0) continue;
    if (cells[f] & kBoundaryBit)
      std::ranges::replace(boundary[cells[f] & ~kBoundaryBit], v, prey[label]);
    else
      std::ranges::replace(tetrahedra[cells[f]], v, prey[label]);
  }
  for (const LocalCell& local : split.deleted) {
    std::array<VertexId, 4> c{};
    for (std::size_t i = 0; i < 4; ++i) c[i] = local[i] & kPreyBit ? prey[local[i] & 3] : link.vertices()[local[i]];
    const auto ghost = static_cast<std::size_t>(std::ranges::find(c, kGhost) - c.begin());
    if (ghost == 4) {
      tetrahedra.push_back(c);
    } else {
      c = withLast(c, ghost);
      boundary.push_back({c[0], c[1], c[2]});
    }
  }
}

}  // namespace qtet
