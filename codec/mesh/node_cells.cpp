#include "codec/mesh/node_cells.h"

#include <algorithm>
#include <cassert>

namespace qtet {

void NodeCells::add(const Slots& first, const Slots& end) {
  assert(tetrahedra.empty() || tetrahedra.back() < first.tetrahedra);
  assert(triangles.empty() || triangles.back() < first.triangles);
  for (CellId t = first.tetrahedra; t < end.tetrahedra; ++t) tetrahedra.push_back(t);
  for (CellId t = first.triangles; t < end.triangles; ++t) triangles.push_back(t);
}

// A vertex between two nodes always has cells of both, however far either is refined. So its star
// never lies in one node.
std::vector<VertexId> innerVertices(const GrowingMesh& mesh, const NodeCells& cells,
                                    VertexCounts& counts) {
  counts.makeRoom(mesh.points.size());
  cells.forEach([&](CellRef ref) {
    for (const VertexId v : mesh.cell(ref))
      if (v != kGhost) counts.add(v, 0);
  });
  std::vector<VertexId> inner;
  for (const VertexId v : counts.counted())
    if (counts.of(v)[0] == mesh.star(v).size()) inner.push_back(v);
  counts.clear();
  std::ranges::sort(inner);
  return inner;
}

}  // namespace qtet
