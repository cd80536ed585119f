// Joins the points that the pieces of one mesh share. A parallel program writes each piece with
// points of its own, so those on a seam stand in the file once a piece.
#pragma once

#include <cstdint>
#include <span>

#include "simplify/split/cell_mesh.h"

namespace qtet {

struct JoinedPieces {
  std::uint64_t points = 0;  ///< joined with a point of an earlier piece
  bool byIds = false;        ///< by CellMesh::pointIds, else by equal coordinates
};

/// Points of different pieces that are one point become one. These have the same id where every
/// piece has ids and equal ids lie at one place, else they lie at exactly the same place. Two
/// points of one piece never do, so that a slit in a piece stays. Where a piece has several points
/// at one place, whole faces decide: a point is joined with that of the cell on the other side. All
/// cells name the earliest point then, which takes what values it misses from the others; these go,
/// and the points behind them move up. `pieceEnds` are behind each piece's last point. REQUIRES:
/// they ascend to the number of points; vertex ids below that or kGhost; pointIds empty or one a
/// point.
JoinedPieces joinPieces(CellMesh& mesh, std::span<const VertexId> pieceEnds);

}  // namespace qtet
