// Makes a cell of its faces. OpenFOAM knows faces alone, not which vertex of a cell is which.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "simplify/split/cell_mesh.h"

namespace qtet {

class CellShaper {
 public:
  /// Forgets the cell before.
  void clear();
  /// Adds a face, whose corners are counter-clockwise seen from outside or, if it is `reversed`,
  /// from inside.
  void addFace(std::span<const VertexId> corners, bool reversed);
  /// Appends the cell: a tetrahedron, hexahedron, wedge or pyramid where the faces are those of
  /// one, else a polyhedron. Vertices and faces stand as VTK's reader of OpenFOAM orders them.
  void addTo(CellMesh& mesh);

 private:
  using Ids = std::vector<VertexId>;

  [[nodiscard]] std::size_t faces() const { return ends_.size(); }
  [[nodiscard]] std::span<const VertexId> face(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
    return std::span(corners_).subspan(begin, ends_[i] - begin);
  }
  [[nodiscard]] std::size_t firstOf(std::size_t corners) const;
  [[nodiscard]] VertexId apexOver(std::size_t base) const;
  [[nodiscard]] VertexId topOf(VertexId a, VertexId b) const;
  [[nodiscard]] CellType kindByCounts() const;
  void setIds(CellType kind);
  [[nodiscard]] bool hasFacesOf(CellType kind);

  Ids corners_;                    ///< of all faces, counter-clockwise seen from outside
  std::vector<std::size_t> ends_;  ///< behind each face's corners
  Ids ids_;                        ///< of the cell
  Ids some_, others_;              ///< sorted corners of two faces
};

}  // namespace qtet
