// Proposals of fusions: the edges of a vertex with their costs, and the proposal that comes of one
// of them. Reads the mesh, changes nothing.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "simplify/cost/fusion_cost.h"
#include "simplify/fuse/candidates.h"
#include "simplify/fuse/change_times.h"
#include "simplify/fuse/fusion_point.h"
#include "simplify/fuse/vertex_counts.h"
#include "simplify/legality/fusion_check.h"
#include "simplify/mesh/fusion_mesh.h"

namespace qtet {

/// The results for an owner's candidates: those that are not legal, and the proposal of the first
/// one that is.
struct Proposal {
  struct Illegal {
    VertexId partner;
    float price;  ///< below it nobody needed to know
  };
  std::vector<Illegal> illegal;
  /// The partner in the edge that the rest is about; kGhost: none is known to be legal.
  VertexId partner = kGhost;
  float price = 0;          ///< FusionPointFinder::price
  bool isPriceAll = false;  ///< it was too dear, so nothing else is known
  Prey prey;
  FusionPoint where;
  /// The cost of the edge alone; and the bound asked for: nothing dearer was looked for in larger
  /// prey.
  float edgeCost = 0, most = 0;
  Star star;
  /// The vertices that could be taken along; which of them were free was part of the decision.
  std::vector<VertexId> companions;
  std::uint32_t madeAfter = 0;   ///< fusions decided on before
  std::uint32_t tetrahedra = 0;  ///< those that the fusion removes
};

/// The factor on a fusion's cost, by the cells that it removes, boundary triangles among them
/// (ALGORITHM.md, "Cost a cell").
class CellShares {
 public:
  CellShares();
  [[nodiscard]] double of(std::size_t cells) const {
    return shares_[std::min(cells, shares_.size() - 1)];
  }

 private:
  std::array<double, kMaxStarCells + 1> shares_{};
};

class FusionProposer {
 public:
  FusionProposer(const FusionMesh& mesh, const FusionCost& cost, const ChangeTimes& changes,
                 const FusionLimits& limits, const FusionPointOptions& options);

  /// The edges of v whose highest vertex it is, cheapest first.
  void candidatesOf(VertexId v, std::vector<Candidate>& found);
  /// The same of a vertex that is higher than all of its neighbours, which are `link`, the ghost
  /// perhaps among them.
  void candidatesOf(VertexId v, std::span<const VertexId> link, std::vector<Candidate>& found);

  /// Proposes the fusion of the first edge of `candidates`, which are `owner`'s, cheapest first. A
  /// triangle or tetrahedron that holds the edge takes its place where that is cheaper for what it
  /// removes. If the edge's price is above `most`, only the price is found. Returns false, and
  /// notes the edge as illegal, when it cannot be fused. No locked vertex is taken along. `now`:
  /// fusions decided on. REQUIRES: neither end of the edge is locked.
  [[nodiscard]] bool propose(VertexId owner, std::span<const Candidate> candidates, float most,
                             std::uint32_t now, Proposal& out);

 private:
  void price(VertexId v, std::vector<Candidate>& found) const;
  void takeAlong(std::span<const Candidate> others, float most, Proposal& out);
  struct Larger {
    Prey prey;
    double share;  // of its cost
  };
  void findCompanions(const Proposal& edge, std::span<const Candidate> others, double below);
  [[nodiscard]] std::optional<Larger> largerPrey(const Proposal& edge, double below) const;

  const FusionMesh& mesh_;
  const FusionCost& cost_;
  const ChangeTimes& changes_;
  FusionCheck test_;
  FusionPointFinder finder_;
  CellShares shares_;
  VertexCounts counts_;
  std::vector<VertexId> companions_;  // the free ones first
  std::size_t freeCompanions_ = 0;
};

/// One a worker.
using Proposers = std::vector<std::unique_ptr<FusionProposer>>;

}  // namespace qtet
