// The faces of a cell of any kind, polyhedra included.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "simplify/split/cell_mesh.h"
#include "simplify/split/cell_shapes.h"

namespace qtet {

/// Calls visit(corners) for each face of a cell. Those of a curved cell have their corners alone.
/// Faces that name a point beyond mesh.points are left out.
template <class Visit>
void forEachFace(const CellMesh& mesh, std::size_t cell, const Visit& visit) {
  const std::span<const VertexId> ids = mesh.cell(cell);
  std::vector<VertexId> corners;
  const auto give = [&] {
    if (std::ranges::all_of(corners, [&](VertexId v) { return v < mesh.points.size(); }))
      visit(std::span<const VertexId>(corners));
  };
  if (mesh.types[cell] == kPolyhedronCell) {
    for (std::size_t at = 1; at < ids.size();) {
      const std::size_t count = std::min<std::size_t>(ids[at], ids.size() - at - 1);
      const auto first = ids.begin() + static_cast<std::ptrdiff_t>(at + 1);
      corners.assign(first, first + static_cast<std::ptrdiff_t>(count));
      at += 1 + count;
      give();
    }
    return;
  }
  const CellShape shape = shapeOf(mesh.types[cell]);
  if (shape.corners > ids.size()) return;
  for (const ShapeFace& face : shape.faces) {
    corners.clear();
    for (std::size_t k = 0; k < face.corners; ++k) corners.push_back(ids[face.corner[k]]);
    give();
  }
}

}  // namespace qtet
