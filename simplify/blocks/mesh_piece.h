// A piece of a mesh that is reduced in blocks (BLOCKS.md), as a value and as bytes. It is all that
// goes from a block of one band to a block of the next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// A vertex of the whole mesh: those of the input by their numbers, later ones by newVertex().
using WholeVertex = std::uint64_t;

/// Vertex number `index` that block `block` of band `band` made. REQUIRES: band < 2^7 - 1, block <
/// 2^25.
[[nodiscard]] WholeVertex newVertex(std::uint32_t band, std::uint32_t block, std::uint32_t index);

/// A place of the original (OriginalSamples) that lies in this piece.
struct PiecePlace {
  std::uint32_t number = 0;  ///< in OriginalSamples::places
  CellId tetrahedron = 0;    ///< as FollowedPlace, in the piece
  std::uint16_t isCovered = 1, isOriginal = 1;
};
static_assert(sizeof(PiecePlace) == 12);  // all of its bytes are written

/// A triangle of the whole mesh's boundary.
struct PieceTriangle {
  Triangle corners{};
  CellId tetrahedron = 0;  ///< whose face it is
};

/// Vertices and tetrahedra count within the piece.
struct MeshPiece {
  std::vector<WholeVertex> vertices;  ///< ascending
  std::vector<LatticePoint> points;   ///< one a vertex
  /// Per field, components a vertex, or a tetrahedron for a cell field.
  std::vector<std::vector<std::int32_t>> values;
  /// The same as flags, empty without missing values.
  std::vector<std::vector<std::uint8_t>> missing;
  /// FusionCost::quadric of each vertex, as far as its sums come from this piece. Empty before the
  /// first band.
  std::vector<double> quadrics;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<PieceTriangle> boundary;
  std::vector<PiecePlace> places;
};

/// How the numbers of a piece belong to it.
struct PieceShape {
  std::vector<FieldInfo> fields;
  std::size_t quadricSize = 0;  ///< numbers of a vertex's quadric
  std::size_t quadricSums = 0;  ///< the first of these are sums
};

using GivePiece = std::function<Status(std::uint32_t block, MeshPiece&& piece)>;

/// The number of no block: such tetrahedra are left out. Their vertices count as those of another
/// block.
inline constexpr std::uint32_t kNoBlock = ~std::uint32_t{0};

/// Gives each block's tetrahedra of `piece` as a piece of their own, in the order of the blocks; a
/// block without any gets none. `blockOf`: by tetrahedron, below `blocks`, or kNoBlock. A vertex of
/// several blocks has its quadric in the first of them; in the others the sums are 0. Returns these
/// vertices, ascending. Errors: those of `give`.
[[nodiscard]] Result<std::vector<WholeVertex>> deal(const MeshPiece& piece, const PieceShape& shape,
                                                    std::span<const std::uint32_t> blockOf,
                                                    std::uint32_t blocks, const GivePiece& give);

/// Pieces of one mesh as one piece, in their order. A vertex of several of them has the sum of
/// their quadrics.
[[nodiscard]] MeshPiece joined(std::span<const MeshPiece> pieces, const PieceShape& shape);

/// The piece as bytes, for this machine alone: CRC-32C of what follows, then the arrays.
[[nodiscard]] Bytes toBytes(const MeshPiece& piece);
/// Errors: bad-checksum, truncated.
[[nodiscard]] Result<MeshPiece> pieceFrom(ByteView bytes);

}  // namespace qtet
