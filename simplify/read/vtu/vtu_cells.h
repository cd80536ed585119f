// The cells of one piece of a .vtu file.
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/read/options/read_options.h"
#include "simplify/read/vtu/vtu_document.h"
#include "simplify/split/cell_mesh.h"

namespace qtet {

/// Which of the file's cells are kept.
class KeptRows {
 public:
  void keep() {
    if (isPartial_) rows_.push_back(next_);
    ++next_;
  }
  void keep(std::uint64_t count) {
    for (std::uint64_t i = 0; isPartial_ && i < count; ++i) rows_.push_back(next_ + i);
    next_ += count;
  }
  void drop() {
    if (!isPartial_) {
      isPartial_ = true;
      for (std::uint64_t i = 0; i < next_; ++i) rows_.push_back(i);
    }
    ++next_;
  }
  /// The number of the cell that is kept or dropped next.
  [[nodiscard]] std::uint64_t next() const { return next_; }
  /// Whether one was dropped. If none was, rows() is empty.
  [[nodiscard]] bool isPartial() const { return isPartial_; }
  [[nodiscard]] const std::vector<std::uint64_t>& rows() const { return rows_; }

 private:
  bool isPartial_ = false;
  std::uint64_t next_ = 0;
  std::vector<std::uint64_t> rows_;
};

/// Marks the cells that are another piece's, or blanked out; empty: none is. Errors: those of
/// readVtu.
[[nodiscard]] Result<std::vector<bool>> hiddenCells(const VtuFile& file,
                                                    const VtuDocument& document,
                                                    const VtuPiece& piece);

/// Appends the piece's volume cells to `out`, their vertices counted from `firstPoint` on, and adds
/// one of `rows` for each cell of the piece. Errors: those of readVtu.
[[nodiscard]] Status readVtuCells(const VtuFile& file, const VtuDocument& document,
                                  const VtuPiece& piece, std::uint64_t firstPoint, CellMesh& out,
                                  KeptRows& rows, ReadReport& report);

}  // namespace qtet
