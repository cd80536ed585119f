// The input's own numbering of points, cells and cells' vertices, for the decoder's mesh of the
// last level (CLOSING.md, "Input order").
#pragma once

#include <span>
#include <vector>

#include "codec/mesh/mesh.h"
#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// A mesh of the last level as the decoder has it, in slot order.
struct DecodedMesh {
  std::span<const LatticePoint> points;
  std::span<const Tetrahedron> tetrahedra;
};

/// The input's numbering of it.
struct InputOrder {
  std::vector<VertexId> points;  ///< slot of the input's point i
  std::vector<CellId> cells;     ///< slot of the input's cell i
  /// The input's cells in its own numbering, vertices in its own order.
  std::vector<Tetrahedron> tetrahedra;
};

/// REQUIRES: `slots` a permutation of the mesh's points.
[[nodiscard]] Bytes encodePointOrder(const DecodedMesh& mesh, std::span<const VertexId> slots);
/// Errors: bad-value (no permutation, a block longer or shorter than it).
[[nodiscard]] Result<std::vector<VertexId>> decodePointOrder(const DecodedMesh& mesh,
                                                             ByteView bytes);

/// REQUIRES: permutations; cells of the same vertices as the mesh's.
[[nodiscard]] Bytes encodeCellOrder(const DecodedMesh& mesh, const InputOrder& order);
/// Fills in cells and tetrahedra. Errors: as decodePointOrder. REQUIRES: order.points is there.
[[nodiscard]] Status decodeCellOrder(const DecodedMesh& mesh, ByteView bytes, InputOrder& order);

}  // namespace qtet
