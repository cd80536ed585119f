// What could be fused: the edges of a vertex with what they would cost, and the proposal that comes of one of them. Reads the mesh, changes nothing.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "simplify/band_nodes.h"
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
  void prefetch(VertexId v) const { __builtin_prefetch(&at_[v]); }
  [[nodiscard]] bool since(VertexId v, std::uint32_t fusion) const { return at_[v] > fusion; }

 private:
  std::vector<std::uint32_t> at_;
};

/// What is known of an owner's candidates: those that are not legal, and what comes of the first that is.
struct Proposal {
  std::vector<VertexId> illegal;  ///< partners
  VertexId partner = kGhost;      ///< of the edge that the rest is about; kGhost: none is known to be legal
  Prey prey;
  FusionPoint where;
  Star star;
  std::vector<VertexId> companions;  ///< that could be taken along: which of them were free was part of the decision
  std::uint32_t madeAfter = 0;       ///< fusions done before
};

class FusionProposer {
 public:
  FusionProposer(const FusionMesh& mesh, const FusionCost& cost, const Touched& touched, const BandNodes& band, const FusionLimits& limits,
                 const FusionPointOptions& options);

  /// The edges of v that the band allows, cheapest first; `onlyLower` = those whose highest vertex it is.
  void candidatesOf(VertexId v, bool onlyLower, std::vector<Candidate>& found);

  /// The fusion of the first edge of `candidates`, which are `owner`'s, cheapest first; or of a triangle or tetrahedron that holds it where that is
  /// cheaper for what it removes. False, and noted as illegal, when it cannot be. No vertex touched since fusion `levelStart` is taken along.
  /// REQUIRES: neither end of the edge is.
  bool propose(VertexId owner, std::span<const Candidate> candidates, std::uint32_t levelStart, std::uint32_t now, Proposal& out);

 private:
  void takeAlong(std::span<const Candidate> others, std::uint32_t levelStart, Proposal& out);
  [[nodiscard]] Prey largerPrey(const Prey& edge, std::span<const Candidate> others, double cost, std::uint32_t levelStart);
  void findCompanions(std::span<const Candidate> others, double cost, std::uint32_t levelStart);

  const FusionMesh& mesh_;
  const FusionCost& cost_;
  const Touched& touched_;
  const BandNodes& band_;
  const std::array<double, 5>& costFactor_;  // by k
  FusionTest test_;
  FusionPointFinder finder_;
  LocalVertices neighbours_;
  std::vector<VertexId> companions_;  // the free ones first
  std::size_t freeCompanions_ = 0;
};

}  // namespace qtet
