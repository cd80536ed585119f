// The mesh of a refiner or of an encoder's mirror of it: grows in place, a record at a time (FORMAT.md, "Refinement").
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/deleted_cells.h"
#include "codec/link.h"
#include "codec/mesh.h"

namespace qtet {

/// A cell of a star: a tetrahedron's slot, or kBoundaryBit | a boundary triangle's slot.
using CellRef = std::uint32_t;
inline constexpr CellRef kBoundaryBit = 0x80000000u;

/// The even permutation of `cell` that puts its vertex `index` last: the other three are the triangle of its link.
[[nodiscard]] inline std::array<VertexId, 4> withLast(const std::array<VertexId, 4>& cell, std::size_t index) {
  static constexpr std::array<std::array<std::uint8_t, 4>, 4> kEven{{{1, 3, 2, 0}, {0, 2, 3, 1}, {0, 3, 1, 2}, {0, 1, 2, 3}}};
  const auto& e = kEven[index];
  return {cell[e[0]], cell[e[1]], cell[e[2]], cell[e[3]]};
}

/// One split as both sides see it.
struct Split {
  int k = 2;
  bool moved = false;
  std::array<LatticePoint, 4> points{};  ///< of the prey vertices; points[0] keeps the slot
  std::vector<LocalCell> deleted;        ///< the cells that come back, oriented
};

class GrowingMesh {
 public:
  std::vector<LatticePoint> points;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Triangle> boundary;
  std::vector<std::uint16_t> born;  ///< level at which a vertex got its present position

  /// The four vertices of a cell; the ghost comes last in a boundary triangle.
  [[nodiscard]] std::array<VertexId, 4> cell(CellRef ref) const {
    if (!(ref & kBoundaryBit)) return tetrahedra[ref];
    const Triangle& t = boundary[ref & ~kBoundaryBit];
    return {t[0], t[1], t[2], kGhost};
  }

  /// Indexes the stars of all present vertices and frees them for splitting.
  void beginLevel();
  /// Vertices that the level may split: those present at its beginning.
  [[nodiscard]] std::uint32_t levelVertices() const { return static_cast<std::uint32_t>(starOffsets_.empty() ? 0 : starOffsets_.size() - 1); }
  [[nodiscard]] bool maysplit(VertexId v) const { return !marked_[v]; }
  [[nodiscard]] std::span<const CellRef> star(VertexId v) const {
    return std::span(starCells_).subspan(starOffsets_[v], starOffsets_[v + 1] - starOffsets_[v]);
  }
  /// Builds the link of v into `link` and marks the star: none of its vertices may split in this level. False: not one sphere,
  /// so that a walk over the link would miss triangles.
  [[nodiscard]] bool enter(VertexId v, Link& link);
  /// Applies a split of v: labels stand in the link's triangles, in star order.
  void apply(VertexId v, const Link& link, const Split& split, std::uint16_t level);

 private:
  std::vector<std::uint32_t> starOffsets_;
  std::vector<CellRef> starCells_;
  std::vector<std::uint8_t> marked_;
};

}  // namespace qtet
