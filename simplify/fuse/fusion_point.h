// Where the prey goes: the legal lattice point of least cost among a few, shape included.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "simplify/cost/fusion_cost.h"
#include "simplify/fuse/fused_integers.h"
#include "simplify/fuse/placement_rule.h"
#include "simplify/legality/fusion_check.h"

namespace qtet {

struct FusionPoint {
  LatticePoint point{};
  double cost = 0;           ///< by which the prey's error grows, the shape's share included
  bool goesOutside = false;  ///< of the boundary as it is, into what the tolerance allows
};

struct FusionPointOptions {
  PlacementRule rule = PlacementRule::kAuto;
  double shapeWeight = 0.5;  ///< FusionOptions::shapeWeight
  /// FusionLimits::displacements of the check that is asked.
  std::span<const std::size_t> displacements{};
};

class FusionPointFinder {
 public:
  FusionPointFinder(const FusionMesh& mesh, const FusionCost& cost,
                    const FusionPointOptions& options)
      : mesh_(mesh), cost_(cost), options_(options), moved_(mesh, cost, options.displacements) {}

  /// The unconstrained minimum of the prey's quadric, and the cost there: by how much it is off
  /// more than its vertices are.
  struct Ideal {
    Vector3 offset{};  ///< from prey.vertex[0]
    double cost = 0;
  };
  [[nodiscard]] Ideal ideal(const Prey& prey) const;
  /// The costs of fusing v with each w, by all that is known without the star. They order the
  /// queue.
  [[nodiscard]] Pair keysOf(VertexId v, std::array<VertexId, 2> w) const;

  /// The fusion's cost if only the envelope had a say. Flips, shapes and topology are known much
  /// later. Empty if the envelope leaves no point. REQUIRES: test.gatherBoundary(prey) was true.
  [[nodiscard]] std::optional<double> price(const Prey& prey, const FusionCheck& test);
  /// Whether a cell flips at every point. The test is made only where that is likely, since it is
  /// cheaper than collecting the star. It is likely where an inner vertex would go to the boundary,
  /// and where many of the last fusions had no legal point. REQUIRES: price(prey, test).
  [[nodiscard]] bool isHopeless(const FusionCheck& test);
  /// The fusion point. REQUIRES: price(prey, test), then test.gatherRest(), was true.
  [[nodiscard]] std::optional<FusionPoint> choose(const FusionCheck& test);
  /// Both. REQUIRES: test.gather(prey) was true.
  [[nodiscard]] std::optional<FusionPoint> find(const Prey& prey, const FusionCheck& test) {
    return price(prey, test) ? choose(test) : std::nullopt;
  }

 private:
  struct Deciding {
    std::array<VertexId, 4> vertex{};
    std::size_t count = 0;
    bool boundary = false, isAll = false;
    Vector3 centre{};  // relative to prey.vertex[0]
  };
  struct Choice {
    LatticePoint point;
    double cost;
    double compared;  // the cost, times what makes a point dearer than others in the log
    bool isOutside;   // of the envelope
  };
  [[nodiscard]] static bool comesFirst(const Choice& a, const Choice& b) {
    return a.compared != b.compared ? a.compared < b.compared : a.point < b.point;
  }

  [[nodiscard]] PreyQuadric growth(const Prey& prey) const;
  [[nodiscard]] Deciding deciding(const Prey& prey) const;
  [[nodiscard]] Ideal idealOf(const Prey& prey, const Deciding& deciding,
                              const PreyQuadric& of) const;
  void addVolume(const FusionCheck& test, Quadric& quadric) const;
  void offer(const LatticePoint& p, bool isOutside, double dearness = 1);
  void offerCheap(const Prey& prey, const FusionCheck& test);
  void offerFree(const FusionCheck& test);
  [[nodiscard]] bool isFreeToCome() const { return std::isfinite(minFree_); }
  [[nodiscard]] bool flipsMoved(const LatticePoint& p, const FusionCheck& test);
  void choose(std::span<const Choice> choices, const FusionCheck& test);
  void count(bool isRefused);

  const FusionMesh& mesh_;
  const FusionCost& cost_;
  FusionPointOptions options_;
  SomeIntegers moved_;  // the displacements
  Prey prey_;
  Quadric quadric_;
  Vector3 origin_{};
  Deciding deciding_;
  Vector3 ideal_{};  // where the quadric is least, relative to origin_
  // what a free point compares as at best; infinity once they are among the choices
  double minFree_ = 0;
  std::vector<Choice> choices_;  // cheapest first as compared
  std::optional<FusionPoint> found_;
  double least_ = 0;  // found_ as compared, shape included
  // the share of the last fusions that had no legal point, but for inner vertices that would go to
  // the boundary
  double refused_ = 0;
};

}  // namespace qtet
