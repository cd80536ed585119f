// Splitting volume cells into tetrahedra so that neighbours agree on the face between them
// (INPUT.md, "Splitting").
#pragma once

#include <array>
#include <cstdint>

#include "simplify/mesh/tet_mesh.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// How quadratic and higher cells are read: all of their nodes are vertices, or their corners
/// alone.
enum class CurvedCells { kSplit, kLinear };

struct SplitOptions {
  CurvedCells curved = CurvedCells::kSplit;
  bool originalIds = false;  ///< with kOriginalCellField
};

struct SplitReport {
  std::array<std::uint64_t, 256> cells{};  ///< by type, how many there were
  /// Points added in cells that no split through their own vertices fits.
  std::uint64_t centrePoints = 0;
  /// Cells other than tetrahedra that were stored inside out, and turned.
  std::uint64_t insideOut = 0;
  std::uint64_t collapsed = 0;  ///< cells of which no tetrahedron remains
  [[nodiscard]] bool onlyTetrahedra() const;
};

/// The field that says which cell of the file a tetrahedron comes from. It is there on request,
/// where a cell was split and no field has the name.
inline constexpr const char* kOriginalCellField = "OriginalCellId";

/// Every quadrilateral is cut from its smallest vertex id. Every polygon of more corners is cut
/// from the smallest that leaves no flat triangle. This rule depends on the face alone, so that
/// both its cells follow it. A cell is then a cone from its smallest vertex that fits the faces'
/// cuts. If none does, it is one from a new point at the mean of its vertices. Tetrahedra stay as
/// they are. Points keep their numbers, new ones follow. Cell fields are inherited; point fields
/// take the mean at new points, integers the value of one of its vertices. Errors: limit-exceeded;
/// bad-input (with kSplit, a number of nodes that no degree has). REQUIRES: a mesh that
/// checkCellMesh has passed.
[[nodiscard]] Result<TetMesh> splitCells(CellMesh&& mesh, const SplitOptions& options,
                                         SplitReport& report);

}  // namespace qtet
