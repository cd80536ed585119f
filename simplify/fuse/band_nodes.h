// The rule for which fusions a band allows (ALGORITHM.md, "Bands"): those whose whole star belongs
// to one node of the k-d tree.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/record/fusion_history.h"
#include "simplify/mesh/fusion_mesh.h"

namespace qtet {

class BandNodes {
 public:
  /// Without a band every fusion is allowed.
  BandNodes() = default;
  /// REQUIRES: `mesh` as it came from `lattice`, nothing fused.
  BandNodes(const FusionMesh& mesh, const LatticeMesh& lattice, std::size_t cellsPerPacket);

  /// Depth of the tree that is left; 0: no bands.
  [[nodiscard]] std::uint32_t depth() const { return bands_.depth; }
  [[nodiscard]] std::uint32_t bands() const {
    return static_cast<std::uint32_t>(bands_.ends.size());
  }
  /// Begins the next band: vertices are inner to a node at depth() - bands(), or between nodes.
  /// REQUIRES: bands() < depth().
  void begin(const FusionMesh& mesh);
  /// Ends it, after level `end` - 1. One without a level is as if it had never been, and false:
  /// there was nothing to fuse.
  bool end(std::uint32_t firstLevel, std::uint32_t end);

  /// The edge's star lies in one node. A prey whose edges are all allowed has its star there, too.
  [[nodiscard]] bool allows(VertexId a, VertexId b) const {
    return nodes_.empty() || (nodes_[a] == nodes_[b] && nodes_[a] != kBetween);
  }
  /// REQUIRES: every fusion was reported to it, in order.
  void fused(VertexId prey) {
    if (!nodes_.empty()) nodes_.push_back(nodes_[prey]);
  }
  [[nodiscard]] Bands take() { return std::move(bands_); }

 private:
  static constexpr std::uint32_t kBetween = ~0u;

  Bands bands_;
  std::vector<std::uint32_t> nodes_;  // by vertex; empty outside a band
};

}  // namespace qtet
