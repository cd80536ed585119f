// What could be fused: the edges of a vertex with what they would cost, and the proposal that comes of one of them. Reads the mesh, changes nothing.
#pragma once

#include <span>
#include <vector>

#include "simplify/candidates.h"
#include "simplify/fusion_cost.h"
#include "simplify/fusion_mesh.h"
#include "simplify/fusion_point.h"
#include "simplify/fusion_test.h"
#include "simplify/local_vertices.h"

namespace qtet {

/// When each vertex was last touched by a fusion, in fusions since the start: what a proposal relies on must not be touched after it was made.
class Touched {
 public:
  void resize(std::size_t vertices) { at_.resize(vertices, 0); }
  void touch(VertexId v, std::uint32_t fusion) { at_[v] = fusion; }
  [[nodiscard]] bool since(VertexId v, std::uint32_t fusion) const { return at_[v] > fusion; }

 private:
  std::vector<std::uint32_t> at_;
};

struct Proposal {
  VertexId owner = 0, partner = 0;  ///< the edge that it was made for
  bool legal = false;
  Prey prey;
  FusionPoint where;
  Star star;
  std::vector<VertexId> ring;   ///< round the edge: which of them could be taken along was part of the decision
  std::uint32_t madeAfter = 0;  ///< fusions done before
};

class FusionProposer {
 public:
  FusionProposer(const FusionMesh& mesh, const FusionCost& cost, const Touched& touched, const FusionLimits& limits, double shapeWeight)
      : mesh_(mesh), cost_(cost), touched_(touched), test_(mesh, limits), finder_(mesh, cost, shapeWeight) {}

  /// The edges of v, cheapest first; `onlyLower` = those whose highest vertex it is.
  void candidatesOf(VertexId v, bool onlyLower, std::vector<Candidate>& found);

  /// The fusion of the edge (owner, partner), or of a triangle or tetrahedron that holds it where that is cheaper for what it removes.
  /// No vertex touched since fusion `levelStart` is taken along. REQUIRES: neither end is.
  void propose(VertexId owner, VertexId partner, std::uint32_t levelStart, std::uint32_t now, Proposal& out);

 private:
  [[nodiscard]] Prey largerPrey(const Prey& edge, std::span<const VertexId> ring, double cost, std::uint32_t levelStart) const;
  void ringOf(const Prey& edge, std::vector<VertexId>& ring) const;

  const FusionMesh& mesh_;
  const FusionCost& cost_;
  const Touched& touched_;
  FusionTest test_;
  FusionPointFinder finder_;
  LocalVertices neighbours_;
};

}  // namespace qtet
