// One block of a band: its cells are fused up to a price, and the places of the original in it are
// followed (BLOCKS.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "proto/error.h"
#include "simplify/blocks/block_planes.h"
#include "simplify/blocks/mesh_piece.h"
#include "simplify/cost/cost_frame.h"
#include "simplify/fuse/fusion_loop.h"
#include "simplify/measure/original_samples.h"

namespace qtet {

/// All that the blocks of a mesh share.
struct BlockFrame {
  Lattice lattice;
  PieceShape shape;
  CostFrame cost;
  FusionOptions options;           ///< without progress; its tolerance is that of the band
  const OriginalSamples* samples;  ///< not null
};

/// A block and what lies beside it.
struct Block {
  std::uint32_t band = 0, number = 0;
  bool isWhole = false;  ///< there is no other block
  MeshPiece piece{};
  std::span<const WholeVertex> shared{};  ///< ascending: vertices that other blocks have too
  std::span<const LatticeBox> others{};   ///< the boxes of the other blocks that are near
};

/// How far the boundary of a block has moved in its band, in lattice steps.
struct BoundaryMove {
  double toMesh = 0, toOriginal = 0;  ///< no point of one is further from the other
  /// The mean of toOriginal times the area, and the area.
  double sum = 0, area = 0;
};

struct FusedBlock {
  MeshPiece piece;
  BoundaryMove moved;
};

/// Thrown where a block cannot be fused; it stays within reduceMesh.
struct BlockFailed {
  Error error;
};

/// Fuses until `end`, at any price if the block is the whole mesh. The result depends on the
/// arguments alone. Throws Stopped, BlockFailed (limit-exceeded: too many levels).
[[nodiscard]] FusedBlock fuseBlock(Block&& block, const BlockFrame& frame, const PartEnd& end);

/// Levels of some parts of a block, for the price of a band. Cells near a seam do not count: the
/// seam keeps them, and a whole mesh has none.
struct SampledParts {
  /// By part. A level removes so many of the cells that count.
  std::vector<std::vector<PartLevel>> levels;
  std::size_t cells = 0;  ///< that count
};
/// One part in `oneIn`, of some `cells` cells between planes, fused down to `share` of its cells.
[[nodiscard]] SampledParts sampleParts(const Block& block, const BlockFrame& frame,
                                       std::size_t cells, std::uint32_t oneIn, double share);

/// Four times the middle of a tetrahedron.
[[nodiscard]] CellMiddle middleOf(std::span<const LatticePoint> points, const Tetrahedron& cell);
[[nodiscard]] inline CellMiddle middleOf(const MeshPiece& piece, CellId cell) {
  return middleOf(piece.points, piece.tetrahedra[cell]);
}

}  // namespace qtet
