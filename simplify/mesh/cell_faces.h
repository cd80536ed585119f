// Finds which cells share faces, and whether they agree on what is inside and outside.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "proto/error.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

inline constexpr CellId kNoCell = 0xFFFFFFFFu;

struct CellNeighbours {
  std::array<CellId, 4> across{kNoCell, kNoCell, kNoCell, kNoCell};  ///< by opposite corner
  /// Bit i: the neighbour across i has the face's vertices in the same rotation, so one of the two
  /// is inside out.
  std::uint8_t disagrees = 0;
};

[[nodiscard]] inline bool repeatsAVertex(const Tetrahedron& t) {
  return t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] ||
         t[2] == t[3];
}

/// The later cells of each set of cells with the same four vertices, ascending. Unspecified once
/// `stopped` is true.
[[nodiscard]] std::vector<CellId> duplicatesIn(std::span<const Tetrahedron> cells,
                                               const std::atomic<bool>* stopped = nullptr);

/// A cell of each face that more than two cells have, by face. REQUIRES: four different vertices a
/// cell.
[[nodiscard]] std::vector<CellId> crowdedFacesIn(std::span<const Tetrahedron> cells);

/// Errors: bad-input for a face of more than two cells; `names[i]` is what cell i is called in the
/// message. Unspecified once `stopped` is true.
[[nodiscard]] Result<std::vector<CellNeighbours>> neighboursOf(
    std::span<const Tetrahedron> cells, std::span<const std::uint64_t> names,
    const std::atomic<bool>* stopped = nullptr);

}  // namespace qtet
