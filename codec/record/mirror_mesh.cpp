#include "codec/record/mirror_mesh.h"

#include <algorithm>
#include <cassert>

#include "codec/mesh/boundary.h"
#include "codec/record/base_coder.h"

namespace qtet {

MirrorMesh::MirrorMesh(const FusionHistory& history)
    : history_(history), slots_(history.points.size(), kGhost) {}

Status MirrorMesh::start(const CoarsePart& coarse, std::span<const std::uint32_t> cells,
                         std::span<const VertexId> vertices) {
  assert(vertices_.empty());
  assert(cells.size() == coarse.tetrahedra.size() && vertices.size() == coarse.points.size());
  const auto isGhost = [](const auto& cell) {
    return std::ranges::find(cell, kGhost) != cell.end();
  };
  const auto ghosts = static_cast<std::uint32_t>(std::ranges::count_if(history_.cells, isGhost));
  const std::size_t fused = std::min(history_.fusions.size(), history_.points.size());
  const Slots total{static_cast<std::uint32_t>(history_.points.size() - fused),
                    static_cast<std::uint32_t>(history_.cells.size()) - ghosts, ghosts};
  mesh_.reserve(total);
  tetrahedra_.reserve(total.tetrahedra), triangles_.reserve(total.triangles);
  vertices_.reserve(total.vertices);
  tetrahedra_.assign(cells.begin(), cells.end());
  vertices_.assign(vertices.begin(), vertices.end());
  for (VertexId v = 0; v < vertices_.size(); ++v) slots_[vertices_[v]] = v;
  mesh_.points.assign(coarse.points.begin(), coarse.points.end());
  mesh_.tetrahedra.assign(coarse.tetrahedra.begin(), coarse.tetrahedra.end());
  mesh_.boundary.assign(coarse.boundary.begin(), coarse.boundary.end());
  mesh_.start(history_.lattice.bits, coarse.frozen);
  return matchBoundary();
}

// The decoder has the boundary of the coarse part; the history's ghost cells must be the same
// triangles.
Status MirrorMesh::matchBoundary() {
  std::vector<std::pair<Triangle, std::uint32_t>> ghosts;
  for (std::uint32_t i = 0; i < history_.cells.size(); ++i)
    if (const auto& c = history_.cells[i];
        history_.live[i] && std::ranges::find(c, kGhost) != c.end()) {
      const auto turned =
          withLast(c, static_cast<std::size_t>(std::ranges::find(c, kGhost) - c.begin()));
      ghosts.emplace_back(sortedFace({slots_[turned[0]], slots_[turned[1]], slots_[turned[2]]}), i);
    }
  std::ranges::sort(ghosts);
  for (const Triangle& t : mesh_.boundary) {
    const auto at = std::ranges::lower_bound(ghosts, std::pair{sortedFace(t), 0u});
    if (at == ghosts.end() || at->first != sortedFace(t))
      return fail(ErrorCode::kBadValue, "a boundary face of the base mesh has no ghost cell");
    triangles_.push_back(at->second);
  }
  if (ghosts.size() != triangles_.size())
    return fail(ErrorCode::kBadValue, "a ghost cell of the base mesh has no boundary face");
  return {};
}

void MirrorMesh::apply(VertexId v, const Link& link, const Split& split, const Fusion& fusion,
                       std::span<const std::uint32_t> restored) {
  assert(vertices_[v] == fusion.fused && restored.size() == split.deleted.size());
  mesh_.apply(v, link, split);
  for (const std::uint32_t cell : restored) {
    const auto& corners = history_.cells[cell];
    const bool ghost = std::ranges::find(corners, kGhost) != corners.end();
    (ghost ? triangles_ : tetrahedra_).push_back(cell);
  }
  assert(triangles_.size() == mesh_.boundary.size());
  assert(tetrahedra_.size() == mesh_.tetrahedra.size());
  vertices_[v] = fusion.prey[0];
  slots_[fusion.prey[0]] = v;
  for (std::size_t i = 1; i < fusion.k; ++i) {
    slots_[fusion.prey[i]] = static_cast<VertexId>(vertices_.size());
    vertices_.push_back(fusion.prey[i]);
  }
  assert(vertices_.size() == mesh_.points.size());
}

}  // namespace qtet
