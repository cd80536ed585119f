// Reduces a mesh to a number of cells, block by block (BLOCKS.md). Only the blocks in hand need
// memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <vector>

#include "simplify/blocks/lattice_pieces.h"
#include "simplify/blocks/original_figures.h"
#include "simplify/blocks/piece_store.h"
#include "simplify/fuse/qtetfusion.h"
#include "simplify/measure/original_samples.h"

namespace qtet {

/// Cells of a block, about. One takes some 300 MB while it is fused.
inline constexpr std::size_t kBlockCells = 1'000'000;

struct ReduceOptions {
  std::size_t cells = 0;  ///< so many tetrahedra are left at most
  std::size_t blockCells = kBlockCells;
  SampleCounts samples{};
  std::uint32_t surfaceSamples = 0;  ///< places on the boundary
  std::uint64_t seed = 1;
  /// Where the pieces wait, once a band; in memory without it.
  MakeSpool spool{};
  std::function<void(double fraction)> progress{};  ///< 0..1
};

/// As a LatticeMesh before its first fusion, with all that has happened to it.
struct ReducedMesh {
  LatticeMesh mesh;
  std::vector<std::vector<std::uint8_t>> missing;  ///< QuantisedMesh::missing
  EarlierFusions fusions;
  OriginalSamples samples;
  std::uint64_t tetrahedra = 0, vertices = 0;  ///< of the original
  std::uint32_t bands = 0;
  double envelopeTolerance = 0;  ///< that is left, FusionOptions::envelopeTolerance
};

/// The result depends on the pieces and options, and on no number of threads. `options` are those
/// for the whole; the threads take a block each. Errors: limit-exceeded (no fusion is left, and
/// more cells are), cancelled, the spool's, those of the pieces. REQUIRES: as simplify; no vertices
/// to keep; figures of these pieces.
[[nodiscard]] Result<ReducedMesh> reduceMesh(LatticePieces& original,
                                             const OriginalFigures& figures,
                                             const FusionOptions& options,
                                             const ReduceOptions& reduce);

}  // namespace qtet
