// The boundary as the fusions decided on leave it: whether one that goes outside would meet it
// (ALGORITHM.md, "The envelope").
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/fuse/fusion_proposer.h"
#include "simplify/mesh/fusion_mesh.h"
#include "simplify/mesh/triangle_overlap.h"
#include "simplify/mesh/triangle_tree.h"

namespace qtet {

class LiveBoundary {
 public:
  /// The boundary of the mesh as it is now. REQUIRES: `mesh` outlives this.
  explicit LiveBoundary(const FusionMesh& mesh);
  LiveBoundary(const LiveBoundary&) = delete;
  LiveBoundary& operator=(const LiveBoundary&) = delete;

  /// Fits the boxes again. Where half of the tree's triangles are gone, makes a new tree.
  void beginLevel();
  /// Whether, with the proposal's prey at its point, a new triangle of the boundary would meet
  /// another one. Also true where a part of the boundary would end inside the solid. Never false
  /// where it would. REQUIRES: nothing in the prey's star has changed since the level began.
  [[nodiscard]] bool isMetBy(const Proposal& proposal);
  /// The proposal is decided on and becomes this vertex.
  void decideOn(const Proposal& proposal, VertexId fused);

 private:
  [[nodiscard]] std::uint32_t numberOf(CellId ghost) const { return ghost - firstGhost_; }
  void place(CellId ghost, std::size_t corner, VertexId vertex, const LatticePoint& at);
  [[nodiscard]] PlacedTriangle triangle(std::uint32_t number) const;
  void collect(const Proposal& proposal);
  [[nodiscard]] TriangleTree treeOfLive() const;
  [[nodiscard]] bool foldsOnItself() const;
  [[nodiscard]] bool isMetBy(const Proposal& proposal, std::uint32_t other) const;
  [[nodiscard]] bool swallows(const LatticePoint& p, const PlacedTriangle& other) const;

  const FusionMesh& mesh_;
  CellId firstGhost_;
  // by boundary triangle, the ghosts in their order: three places in points_, and the ghost
  std::vector<TriangleTree::Cell> triangles_;
  std::vector<LatticePoint> points_;  // three a triangle
  std::vector<std::array<VertexId, 3>> vertices_;
  std::vector<std::uint8_t> live_;
  TriangleTree tree_;
  // new_: the boundary triangles of the proposal in hand with the prey at its point. left_: the
  // triangles of the prey as it is which that point is outside of.
  std::vector<PlacedTriangle> new_, left_;
};

}  // namespace qtet
