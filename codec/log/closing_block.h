// The blocks behind a log's last chunk (FORMAT.md, "Closing blocks").
#pragma once

#include <cstdint>

#include "codec/log/chunk_entry.h"

namespace qtet {

/// The content of a closing block (FORMAT.md, "Closing blocks").
enum class ClosingKind : std::uint32_t {
  kPointOrder = 1,      ///< the input's numbering of points
  kCellOrder = 2,       ///< the input's numbering of cells and of their vertices; needs the points'
  kExactPositions = 3,  ///< the input's own coordinates
  kExactField = 4,      ///< the input's own values of one field
  kOriginalCells = 5,   ///< the file's cell that each was split from; needs the cells' order
};

/// A block behind the last chunk. No level needs it: who wants the input itself and not only its
/// mesh on the lattice fetches it.
struct ClosingBlock {
  /// Or one that this build does not know, to be left alone.
  ClosingKind kind = ClosingKind::kPointOrder;
  std::uint32_t field = 0;  ///< of kExactField; else 0
  BlockEntry block;
};

}  // namespace qtet
