#include "codec/mesh/compact_mesh.h"

#include <algorithm>

namespace qtet {
namespace {

/// Keeps the tuples for which `isHole(i)` is false.
template <class Items, class IsHole>
void keep(Items& items, std::size_t components, const IsHole& isHole) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < items.size() / components; ++i) {
    if (isHole(i)) continue;
    for (std::size_t c = 0; c < components; ++c)
      items[n * components + c] = items[i * components + c];
    ++n;
  }
  items.resize(n * components);
}

}  // namespace

void dropHoles(LatticeMesh& mesh) {
  std::vector<bool> pointHole, cellHole, triangleHole;
  std::vector<VertexId> now;
  VertexId next = 0;
  for (const LatticePoint& p : mesh.points) {
    pointHole.push_back(p == kHolePoint);
    now.push_back(pointHole.back() ? 0 : next++);
  }
  for (const Tetrahedron& t : mesh.tetrahedra) cellHole.push_back(t == kHoleTetrahedron);
  for (const Triangle& t : mesh.boundary) triangleHole.push_back(t == kHoleTriangle);
  for (std::size_t f = 0; f < mesh.fields.size(); ++f) {
    const std::vector<bool>& holes = isCellField(mesh.fields[f]) ? cellHole : pointHole;
    keep(mesh.values[f], mesh.fields[f].components, [&](std::size_t i) { return holes[i]; });
  }
  keep(mesh.points, 1, [&](std::size_t i) { return pointHole[i]; });
  keep(mesh.tetrahedra, 1, [&](std::size_t i) { return cellHole[i]; });
  keep(mesh.boundary, 1, [&](std::size_t i) { return triangleHole[i]; });
  for (Tetrahedron& t : mesh.tetrahedra)
    for (VertexId& v : t) v = now[v];
  for (Triangle& t : mesh.boundary)
    for (VertexId& v : t) v = now[v];
}

}  // namespace qtet
