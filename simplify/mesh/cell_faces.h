// Finds which cells share faces, and whether they agree on what is inside and outside.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

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

/// Which cells share faces.
struct MatchedFaces {
  std::vector<CellNeighbours> neighbours;  ///< by cell; across faces of two cells alone
  /// The later cells of each set of cells with the same four vertices, ascending.
  std::vector<CellId> duplicates;
  std::vector<CellId> crowded;     ///< a cell of each face of more than two, ascending
  std::vector<CellId> firstCrowd;  ///< all cells of the first of these faces

  /// The boundary in the order of boundaryOf(cells). REQUIRES: the cells that were matched.
  [[nodiscard]] std::vector<Triangle> boundaryOf(std::span<const Tetrahedron> cells) const;
};

/// Unspecified once `stopped` is true. REQUIRES: four different vertices a cell.
[[nodiscard]] MatchedFaces matchFaces(std::span<const Tetrahedron> cells,
                                      const std::atomic<bool>* stopped = nullptr);

}  // namespace qtet
