#include "simplify/read/foam/cell_shaper.h"

#include <algorithm>

#include "simplify/split/cell_shapes.h"

namespace qtet {

namespace {

/// Goes round the other way from the same corner, as VTK does.
void turn(std::span<VertexId> corners) {
  if (!corners.empty()) std::ranges::reverse(corners.subspan(1));
}

}  // namespace

void CellShaper::clear() {
  corners_.clear();
  ends_.clear();
}

void CellShaper::addFace(std::span<const VertexId> corners, bool reversed) {
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  if (reversed) turn(std::span(corners_).last(corners.size()));
  ends_.push_back(corners_.size());
}

/// The first face of so many corners; faces() if there is none.
std::size_t CellShaper::firstOf(std::size_t corners) const {
  std::size_t i = 0;
  while (i < faces() && face(i).size() != corners) ++i;
  return i;
}

CellType CellShaper::kindByCounts() const {
  std::size_t triangles = 0, quads = 0;
  for (std::size_t i = 0; i < faces(); ++i) {
    triangles += face(i).size() == 3 ? 1 : 0;
    quads += face(i).size() == 4 ? 1 : 0;
  }
  if (triangles + quads != faces()) return kPolyhedronCell;
  if (triangles == 4 && quads == 0) return kTetrahedronCell;
  if (triangles == 4 && quads == 1) return kPyramidCell;
  if (triangles == 2 && quads == 3) return kWedgeCell;
  if (triangles == 0 && quads == 6) return kHexahedronCell;
  return kPolyhedronCell;
}

/// A corner that the base has not.
VertexId CellShaper::apexOver(std::size_t base) const {
  for (const VertexId v : corners_)
    if (std::ranges::find(face(base), v) == face(base).end()) return v;
  return kGhost;
}

/// The corner above `a` in the quadrilateral that goes from a to b.
VertexId CellShaper::topOf(VertexId a, VertexId b) const {
  for (std::size_t i = 0; i < faces(); ++i) {
    const std::span<const VertexId> corners = face(i);
    if (corners.size() != 4) continue;
    for (std::size_t k = 0; k < 4; ++k)
      if (corners[k] == a && corners[(k + 1) % 4] == b) return corners[(k + 3) % 4];
  }
  return kGhost;
}

void CellShaper::setIds(CellType kind) {
  const std::size_t base = kind == kPyramidCell ? firstOf(4) : kind == kWedgeCell ? firstOf(3) : 0;
  const std::span<const VertexId> corners = face(base);
  const std::size_t n = corners.size();
  ids_.assign(corners.begin(), corners.end());
  // VTK looks at a wedge's first triangle from outside, at every other base from inside
  if (kind != kWedgeCell) turn(ids_);
  if (kind == kHexahedronCell)
    for (std::size_t k = 0; k < n; ++k) ids_.push_back(topOf(ids_[k], ids_[(k + 1) % n]));
  else if (kind == kWedgeCell)
    for (std::size_t k = 0; k < n; ++k) ids_.push_back(topOf(ids_[k], ids_[(k + n - 1) % n]));
  else
    ids_.push_back(apexOver(base));
}

/// Whether each face of a cell `kind` with these ids is one of the faces. Counts alone do not say
/// so: some polyhedra of six quadrilaterals are no hexahedra.
bool CellShaper::hasFacesOf(CellType kind) {
  some_ = ids_;
  std::ranges::sort(some_);
  if (std::ranges::adjacent_find(some_) != some_.end() || some_.back() == kGhost) return false;
  return std::ranges::all_of(shapeOf(kind).faces, [&](const ShapeFace& wanted) {
    some_.clear();
    for (std::size_t k = 0; k < wanted.corners; ++k) some_.push_back(ids_[wanted.corner[k]]);
    std::ranges::sort(some_);
    for (std::size_t i = 0; i < faces(); ++i) {
      others_.assign(face(i).begin(), face(i).end());
      std::ranges::sort(others_);
      if (some_ == others_) return true;
    }
    return false;
  });
}

void CellShaper::addTo(CellMesh& mesh) {
  const CellType kind = kindByCounts();
  if (kind != kPolyhedronCell) {
    setIds(kind);
    if (hasFacesOf(kind)) return mesh.addCell(kind, ids_);
  }
  ids_.assign(1, static_cast<VertexId>(faces()));
  for (std::size_t i = 0; i < faces(); ++i) {
    ids_.push_back(static_cast<VertexId>(face(i).size()));
    ids_.insert(ids_.end(), face(i).begin(), face(i).end());
  }
  mesh.addCell(kPolyhedronCell, ids_);
}

}  // namespace qtet
