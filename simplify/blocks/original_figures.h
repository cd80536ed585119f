// Figures of the whole original that the reduction and its cost need, summed over its pieces
// (BLOCKS.md).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "simplify/blocks/block_planes.h"
#include "simplify/blocks/lattice_pieces.h"
#include "simplify/cost/cost_frame.h"
#include "simplify/cost/mesh_figures.h"

namespace qtet {

class OriginalFigures final : public MeshFigures {
 public:
  /// Goes through all pieces once. Errors: those of forEach.
  [[nodiscard]] static Result<OriginalFigures> of(LatticePieces& pieces);

  [[nodiscard]] std::span<const FieldInfo> fields() const override { return pieces_->fields(); }
  [[nodiscard]] std::uint64_t tetrahedra() const override { return pieces_->tetrahedra(); }
  [[nodiscard]] std::span<const std::uint8_t> isOneValue() const override { return isOneValue_; }
  [[nodiscard]] std::vector<double> fieldErrors(std::span<const CostPart> parts) const override;
  /// Goes through all pieces once more.
  [[nodiscard]] Result<double> boundaryWeight(std::span<const CostPart> parts,
                                              std::span<const double> errors) const override;
  [[nodiscard]] const LabelFinder& labels() const override { return labels_; }

  /// Errors: those of boundaryWeight, where `options` give none.
  [[nodiscard]] Result<CostFrame> costFrame(const CostOptions& options) const;
  [[nodiscard]] double diagonal() const { return diagonal_; }  ///< diagonalOf
  [[nodiscard]] double volume6() const { return volume6_; }    ///< six times the volume
  /// As wallThicknessOf (loss_warnings.h).
  [[nodiscard]] double wallThickness() const;
  /// The sums of placesMeasure over the cells and over the boundary.
  [[nodiscard]] double cellMeasure() const { return cellMeasure_; }
  [[nodiscard]] double surfaceMeasure() const { return surfaceMeasure_; }
  [[nodiscard]] const std::vector<double>& ranges() const { return ranges_; }  ///< rangesOf
  /// Those of every so-many-th cell.
  [[nodiscard]] const std::vector<CellMiddle>& middles() const { return middles_; }

 private:
  class Look;

  explicit OriginalFigures(LatticePieces& pieces) : pieces_(&pieces), labels_(pieces.fields()) {}

  LatticePieces* pieces_;
  std::vector<std::uint8_t> isOneValue_;
  std::vector<double> ranges_;
  LabelFinder labels_;
  double diagonal_ = 1, volume6_ = 0, cellMeasure_ = 0, surfaceMeasure_ = 0;
  std::uint64_t faceStep_ = 1, edgeStep_ = 1;
  LatticeMesh faceCells_;  // the cells of sampled faces
  LatticeMesh edgeCells_;  // the boundary triangles of sampled edges
  LatticeMesh vertices_;   // some vertices, where fields have too many components for the cost
  std::vector<CellMiddle> middles_;
};

/// Cells whose middles choose the planes of a band, about.
inline constexpr std::size_t kSampledMiddles = 200'000;

}  // namespace qtet
