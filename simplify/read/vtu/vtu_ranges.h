// Ranges of a piece's points and cells, for a caller that cannot hold the whole file. Only the
// bytes of the range are read. Text, and compressed blocks that the range cuts, are decoded whole.
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/read/vtu/vtu_document.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Some of a piece's points or cells: `count` from number `first` on.
struct VtuRange {
  std::uint64_t first = 0, count = 0;
};

/// Errors: those of readVtu. REQUIRES: the range lies within the piece's points.
[[nodiscard]] Result<std::vector<Position>> readVtuPointRange(const VtuFile& file,
                                                              const VtuDocument& document,
                                                              const VtuPiece& piece,
                                                              const VtuRange& range);

/// The cells of the range, of every kind and hidden ones too, with vertices numbered from 0 in the
/// piece; no points and no fields. Errors: those of readVtu; bad-input for polyhedra, whose faces
/// have no ranges. REQUIRES: the range lies within the piece's cells.
[[nodiscard]] Result<CellMesh> readVtuCellRange(const VtuFile& file, const VtuDocument& document,
                                                const VtuPiece& piece, const VtuRange& range);

/// The values of an array of the piece's points or cells, a tuple each. Errors: those of readVtu.
/// REQUIRES: the range lies within its `tuples`.
[[nodiscard]] Result<std::vector<double>> readVtuValueRange(const VtuFile& file,
                                                            const VtuDocument& document,
                                                            const VtuArray& array,
                                                            std::uint64_t tuples,
                                                            const VtuRange& range);

}  // namespace qtet
