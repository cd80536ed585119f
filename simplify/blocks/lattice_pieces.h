// A mesh on the lattice that comes in pieces, as the reduction takes it (BLOCKS.md).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/error.h"
#include "simplify/blocks/mesh_piece.h"

namespace qtet {

struct GivenPiece {
  MeshPiece piece;                  ///< without quadrics and places
  std::vector<WholeVertex> shared;  ///< ascending: those of its vertices that other pieces have too
  std::uint32_t number = 0;         ///< 0, 1, 2 ...
  bool isLast = false;
};
using TakePiece = std::function<Status(GivenPiece&&)>;

class LatticePieces {
 public:
  virtual ~LatticePieces() = default;
  [[nodiscard]] virtual const Lattice& lattice() const = 0;
  [[nodiscard]] virtual const std::vector<FieldInfo>& fields() const = 0;
  [[nodiscard]] virtual std::uint64_t tetrahedra() const = 0;
  [[nodiscard]] virtual std::uint64_t vertices() const = 0;
  [[nodiscard]] virtual std::uint64_t triangles() const = 0;  ///< of the boundary
  /// Gives all pieces, the same in the same order each time. Errors: those of `take` and of reading
  /// the pieces.
  [[nodiscard]] virtual Status forEach(const TakePiece& take) = 0;
};

}  // namespace qtet
