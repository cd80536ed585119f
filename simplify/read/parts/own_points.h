// Cells that have points of their own. MFEM, deal.II, Firedrake and their kin write each cell so,
// or each cell's refined patch: no other one names its points.
#pragma once

#include <cstdint>

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// A patch has at most so many points on average: those of a hexahedron of degree 10, the highest
/// that VTK knows.
inline constexpr std::uint64_t kMostPatchPoints = 1331;
/// Patches are taken for one mesh where more than this share of their points lie at the place of
/// another patch's point. Parts of an assembly touch at far fewer.
inline constexpr double kMostCoincide = 0.5;
/// At most this share of such points may have other values (kSameValues). A field that jumps at an
/// interface differs at fewer, one that jumps from cell to cell at most of them.
inline constexpr double kFewDiffer = 0.01;

struct OwnPoints {
  std::uint64_t patches = 0;     ///< runs of cells that share points; 0: no cells of this kind
  std::uint64_t coincident = 0;  ///< points at the place of another patch's earlier point
  std::uint64_t differing = 0;   ///< those of them whose values differ
  std::uint64_t joined = 0;      ///< points joined with an earlier one
  [[nodiscard]] bool isTorn() const { return patches > 0 && joined == 0; }
};

enum class OwnJoin : std::uint8_t {
  kNever,     ///< only says what there is
  kByValues,  ///< where at most kFewDiffer of the points have other values, and these stay apart
  kStep,      ///< as kByValues, but for a step of a series, whose steps have one mesh: all points
  kAlways,    ///< all points, whatever their values
};

/// Joins the patches of a mesh at the points that they share, as pieces are (joinPieces).
/// REQUIRES: checkCellMesh(mesh) succeeded.
OwnPoints joinOwnPoints(CellMesh& mesh, OwnJoin how);

}  // namespace qtet
