// Draws the places of the original that are followed, while its pieces go by (BLOCKS.md).
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "simplify/blocks/lattice_pieces.h"
#include "simplify/blocks/original_figures.h"
#include "simplify/measure/original_samples.h"

namespace qtet {

struct SamplerOptions {
  SampleCounts counts{};
  std::uint32_t surface = 0;  ///< places on the boundary
  std::uint64_t seed = 1;
};

class OriginalSampler {
 public:
  OriginalSampler(const LatticePieces& whole, const OriginalFigures& figures,
                  const SamplerOptions& options);

  /// Gives the piece its places. REQUIRES: the pieces in their order.
  void take(GivenPiece& given);
  /// After the last piece. OriginalSamples::toMesh and the places' cells are not set.
  [[nodiscard]] OriginalSamples samples();

 private:
  void drawIn(MeshPiece& piece, CellId cell);
  void drawVertices(GivenPiece& given);
  void addTruth(const MeshPiece& piece, CellId cell, const std::array<double, 4>& weights,
                std::vector<std::vector<double>>& truth);

  const LatticePieces& whole_;
  PlaceDraw volume_, surface_;
  std::uint32_t uniform_ = 0;     // places in the volume, in all
  std::uint64_t vertexStep_ = 0;  // 0: no vertices
  std::set<WholeVertex> taken_;   // of those shared by pieces
  OriginalSamples out_;
  std::vector<FollowedPlace> vertices_;
  std::vector<std::vector<double>> vertexTruth_;  // by field
};

}  // namespace qtet
