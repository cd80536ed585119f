// A mesh from outside that is read piece by piece, so that nobody holds all of it (BLOCKS.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "proto/error.h"
#include "simplify/blocks/mesh_piece.h"
#include "simplify/mesh/tet_mesh.h"

namespace qtet {

/// Cells of a piece at most.
inline constexpr std::size_t kPieceCells = 1'000'000;

struct InputPiece {
  /// Cells with all of their points; all pieces have the same fields in the same order.
  TetMesh mesh;
  std::vector<WholeVertex> vertices;  ///< ascending, one a point
  std::uint64_t firstCell = 0;        ///< its cells are numbered from here on in the input
  /// Points of one part are different points, wherever they lie. Points of two parts at exactly the
  /// same place are one.
  std::uint32_t part = 0;
};

class InputPieces {
 public:
  virtual ~InputPieces() = default;
  /// Vertices of the input are numbered below this; those that splitting has added, above.
  [[nodiscard]] virtual std::uint64_t points() const = 0;
  [[nodiscard]] virtual std::uint32_t parts() const { return 1; }
  /// The pieces one after the other, parts and cells ascending; nothing after the last one. Errors:
  /// those of reading.
  [[nodiscard]] virtual Result<std::optional<InputPiece>> next() = 0;
};

}  // namespace qtet
