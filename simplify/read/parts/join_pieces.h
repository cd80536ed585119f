// Joins the points that the pieces of one mesh share. A parallel program writes each piece with
// points of its own, so those on a seam stand in the file once a piece.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Pairs of blocks by their numbers, the lesser number first.
using NumberPairs = std::set<std::pair<std::int32_t, std::int32_t>>;

struct JoinedPieces {
  std::uint64_t points = 0;  ///< joined with a point of an earlier piece
  bool byIds = false;        ///< by CellMesh::pointIds, else by their places
  /// Those of `points` that do not lie at exactly the same place (near_points.h).
  std::uint64_t nearPoints = 0;
  /// Near points that were not joined: the pieces do not fit together there.
  std::uint64_t apartPoints = 0;
  /// Points that stay apart from one of another block, with which they would be joined else.
  std::uint64_t blockPoints = 0;
  /// Those of `points` that had other values than one of another block (point_values.h).
  std::uint64_t differingPoints = 0;
  bool blocksMeet = false;  ///< points of different blocks are joined, or stay apart
  /// The blocks that have such points whose values differ.
  NumberPairs differing{};
};

/// The pieces are blocks of a file, such as parts of different materials.
struct BlocksOfPoints {
  std::vector<std::int32_t> block;  ///< one a point, 0 for none; empty: the file has no blocks
  /// Blocks whose points stay apart; nullopt: those points do whose values differ.
  std::optional<NumberPairs> apart{};
};

/// Points of different pieces that are one point become one. These have the same id where every
/// piece has ids and equal ids lie at one place, else they lie at exactly the same place. Points
/// that lie within kNearShare of their shortest edges are one too, where faces of two pieces fit
/// together then. Two points of one piece never are, so that a slit in a piece stays. Where a piece
/// has several points at one place, whole faces decide: a point is joined with that of the cell on
/// the other side. Points of blocks that `blocks` keeps apart never become one, also not through a
/// third block. All cells name the earliest point then, which takes what
/// values it misses from the others; these go, and the points behind them move up. `pieceEnds` are
/// behind each piece's last point. REQUIRES: they ascend to the number of points; vertex ids below
/// that or kGhost; pointIds empty or one a point.
JoinedPieces joinPieces(CellMesh& mesh, std::span<const VertexId> pieceEnds,
                        const BlocksOfPoints& blocks = {});

}  // namespace qtet
