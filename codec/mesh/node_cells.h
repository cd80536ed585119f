// The live cells of one node of the tree in the layout `regions`, and the vertices whose whole star
// lies in it (FORMAT.md, "Packets"). Its packet may split these vertices. Found from the node's own
// cells, so that the work is the packet's, not the mesh's.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <vector>

#include "codec/mesh/growing_mesh.h"

namespace qtet {

/// Ascending slots.
struct NodeCells {
  std::vector<CellId> tetrahedra, triangles;

  /// Adds the slots from `first` to `end`. REQUIRES: above those that it has.
  void add(const Slots& first, const Slots& end);
  [[nodiscard]] std::size_t size() const { return tetrahedra.size() + triangles.size(); }
  [[nodiscard]] bool empty() const { return tetrahedra.empty() && triangles.empty(); }
  /// Calls visit(ref) with every cell, tetrahedra first.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (const CellId t : tetrahedra) visit(CellRef{t});
    for (const CellId t : triangles) visit(CellRef{t | kBoundaryBit});
  }
};

/// Two counts a vertex, all 0 between two uses; only vertices that were counted are touched.
class VertexCounts {
 public:
  using Counts = std::array<std::uint32_t, 2>;

  /// Room to count vertices below `vertices`. REQUIRES: no vertex is counted.
  void makeRoom(std::size_t vertices) {
    assert(counted_.empty());
    if (counts_.size() < vertices) counts_.resize(vertices);
  }
  void add(VertexId v, std::size_t which) {
    Counts& c = counts_[v];
    if (c[0] + c[1] == 0) counted_.push_back(v);
    ++c[which];
  }
  [[nodiscard]] const Counts& of(VertexId v) const { return counts_[v]; }
  /// In the order of their first count.
  [[nodiscard]] const std::vector<VertexId>& counted() const { return counted_; }
  void clear() {
    for (const VertexId v : counted_) counts_[v] = {};
    counted_.clear();
  }

 private:
  std::vector<Counts> counts_;
  std::vector<VertexId> counted_;
};

/// The vertices all of whose cells are the node's, ascending. `counts` is scratch.
[[nodiscard]] std::vector<VertexId> innerVertices(const GrowingMesh& mesh, const NodeCells& cells,
                                                  VertexCounts& counts);

}  // namespace qtet
