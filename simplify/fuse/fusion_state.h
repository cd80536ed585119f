// Everything that a fusion changes: the mesh, what its vertices cost, their candidates, and when
// each was changed. All of them are as long as the mesh has vertex slots, and dead vertices have no
// candidates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "simplify/cost/fusion_cost.h"
#include "simplify/fuse/candidates.h"
#include "simplify/fuse/change_times.h"
#include "simplify/mesh/fusion_mesh.h"
#include "simplify/mesh/workers.h"

namespace qtet {

class FusionState {
 public:
  /// REQUIRES: as FusionMesh and FusionCost.
  FusionState(const LatticeMesh& lattice, std::size_t regionField, const CostOptions& cost,
              Workers& workers);
  /// A block of a mesh, as FusionCost takes it.
  FusionState(const LatticeMesh& block, std::size_t regionField, const CostFrame& frame,
              std::span<const Triangle> boundary);
  /// A part of a mesh, as FusionCost takes it.
  FusionState(const LatticeMesh& part, std::size_t regionField, const CostFrame& frame,
              std::span<const double> quadrics);
  FusionState(const FusionState&) = delete;
  FusionState& operator=(const FusionState&) = delete;

  /// Takes these out of all fusions to come (FusionMesh::keep).
  void keep(std::span<const VertexId> vertices) { mesh_.keep(vertices); }
  [[nodiscard]] const FusionMesh& mesh() const { return mesh_; }
  [[nodiscard]] const FusionCost& cost() const { return cost_; }
  [[nodiscard]] const ChangeTimes& changes() const { return changes_; }
  [[nodiscard]] ChangeTimes& changes() { return changes_; }
  [[nodiscard]] const Candidates& candidates() const { return candidates_; }
  [[nodiscard]] Candidates& candidates() { return candidates_; }

  /// The owner's cheapest candidate that is alive and has not failed, or none; dead ones are
  /// dropped. Threads may ask at once, each for owners of its own.
  const Candidate* bestAlive(VertexId owner);

  /// Fuses the prey into a vertex at `point`. REQUIRES: as FusionMesh::fuse.
  void fuse(const Prey& prey, const LatticePoint& point, const Star& star, std::uint32_t level);

  /// The same with these integers. REQUIRES: no candidates.
  void fuse(const Prey& prey, const FusedVertex& what, const Star& star, std::uint32_t level);

  [[nodiscard]] FusionHistory takeHistory(std::uint32_t levels) {
    return mesh_.takeHistory(levels);
  }

 private:
  void fuse(const Prey& prey, const FusedVertex& what, std::span<const double> values,
            const Star& star, std::uint32_t level);
  void findIntegers(const Prey& prey, const LatticePoint& point, std::span<const double> values);

  FusionMesh mesh_;
  FusionCost cost_;
  ChangeTimes changes_;
  Candidates candidates_;
  std::vector<std::int32_t> integers_;  // of the vertex that is fused: FusedVertex::values
};

}  // namespace qtet
