// The encoder's mirror of the decoder's mesh. It grows in the same slots, and knows which vertex
// and which cell of the history each slot holds.
#pragma once

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/prefetch.h"
#include "codec/mesh/coarse_part.h"
#include "codec/mesh/growing_mesh.h"
#include "codec/record/fusion_history.h"
#include "proto/error.h"

namespace qtet {

class MirrorMesh {
 public:
  /// Empty. `history` must outlive it.
  explicit MirrorMesh(const FusionHistory& history);

  /// Takes the coarse part, and what the history calls each of its tetrahedra and vertices. Errors:
  /// bad-value (the history's ghost cells are not its boundary). REQUIRES: called once and first.
  Status start(const CoarsePart& coarse, std::span<const std::uint32_t> cells,
               std::span<const VertexId> vertices);
  /// Applies a split of v, which undoes `fusion`: as GrowingMesh::apply. `restored` holds the
  /// history's cell of each of `split.deleted`.
  void apply(VertexId v, const Link& link, const Split& split, const Fusion& fusion,
             std::span<const std::uint32_t> restored);

  [[nodiscard]] GrowingMesh& mesh() { return mesh_; }
  [[nodiscard]] const GrowingMesh& mesh() const { return mesh_; }
  /// By slot: the history's vertices and its cells that are tetrahedra.
  [[nodiscard]] const std::vector<VertexId>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<std::uint32_t>& tetrahedra() const { return tetrahedra_; }
  /// A hint: the star of v is soon split.
  void expect(VertexId v) const {
    for (const CellRef ref : mesh_.star(v)) {
      mesh_.expectCell(ref);
      prefetch(ref & kBoundaryBit ? &triangles_[ref & ~kBoundaryBit] : &tetrahedra_[ref]);
    }
  }
  /// A hint: slotOf(vertex) comes soon.
  void expectSlot(VertexId vertex) const {
    if (vertex != kGhost) prefetch(&slots_[vertex]);
  }
  /// The history's cell.
  [[nodiscard]] std::uint32_t cellOf(CellRef ref) const {
    return ref & kBoundaryBit ? triangles_[ref & ~kBoundaryBit] : tetrahedra_[ref];
  }
  /// Whether a vertex of the history has come; the ghost is always there.
  [[nodiscard]] bool has(VertexId vertex) const {
    return vertex == kGhost || slots_[vertex] != kGhost;
  }
  /// Where a vertex of the history is, the ghost included. REQUIRES: it has come.
  [[nodiscard]] VertexId slotOf(VertexId vertex) const {
    assert(has(vertex));
    return vertex == kGhost ? kGhost : slots_[vertex];
  }

 private:
  Status matchBoundary();

  const FusionHistory& history_;
  GrowingMesh mesh_;
  std::vector<VertexId> vertices_;
  std::vector<std::uint32_t> tetrahedra_, triangles_;
  std::vector<VertexId> slots_;  // by vertex of the history
};

}  // namespace qtet
