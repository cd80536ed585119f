// Points of different pieces that rounding has moved apart. Where each process moves or writes its
// piece by itself, the points on a seam differ in the last digits.
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/read/parts/point_sets.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Points this close are one, as a share of the shortest edge at either. Rounding moves them by
/// less, and a gap that is meant is wider.
inline constexpr double kNearShare = 0.01;

struct NearPoints {
  /// A number for each point: points of one group have the same one, the first point's.
  std::vector<VertexId> groups;
  /// Points near one of another piece that are in no group, since no face of theirs closes.
  std::uint64_t apart = 0;
};

/// Groups of points that are one but for rounding: points of the surfaces of different pieces
/// within kNearShare of their shortest edges. A group has two faces of different pieces whose
/// corners are all in the same groups, so that the pieces fit together there.
[[nodiscard]] NearPoints nearPoints(const CellMesh& mesh, const PieceOf& pieceOf);

}  // namespace qtet
