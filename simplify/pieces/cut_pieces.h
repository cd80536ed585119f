// The pieces of a mesh that is at hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "simplify/pieces/input_pieces.h"

namespace qtet {

class CutPieces final : public InputPieces {
 public:
  explicit CutPieces(TetMesh&& mesh, std::size_t pieceCells = kPieceCells)
      : points_(mesh.points.size()), mesh_(std::move(mesh)), pieceCells_(pieceCells) {}

  [[nodiscard]] std::uint64_t points() const override { return points_; }
  [[nodiscard]] Result<std::optional<InputPiece>> next() override;

 private:
  std::uint64_t points_;
  TetMesh mesh_;
  std::size_t pieceCells_, nextCell_ = 0;
};

/// The cells from `begin` to `end` of a mesh, with their points.
[[nodiscard]] InputPiece cutOut(const TetMesh& mesh, std::size_t begin, std::size_t end);

}  // namespace qtet
