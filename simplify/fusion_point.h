// Where the prey goes: the legal lattice point of least cost among a few, shape included.
#pragma once

#include <optional>
#include <vector>

#include "simplify/fusion_cost.h"
#include "simplify/fusion_test.h"

namespace qtet {

struct FusionPoint {
  LatticePoint point{};
  double cost = 0;    ///< the shape's share included
  float outside = 0;  ///< FusedVertex::outside
};

/// Which points are looked at. A free point takes twice the bits of one that follows from its prey.
enum class PlacementRule : std::uint8_t {
  kOptimal,  ///< the quadric's minimum (Eq. 6-7), and what lies between it and the prey's middle
  kVertex,   ///< the prey vertices alone, which keeps every vertex of every level an original one
  kAuto,     ///< prey vertices, middle and quarters; a free point only where it costs less than half of theirs
};

struct FusionPointOptions {
  PlacementRule rule = PlacementRule::kAuto;
  double shapeWeight = 0.5;  ///< FusionOptions::shapeWeight
};

class FusionPointFinder {
 public:
  FusionPointFinder(const FusionMesh& mesh, const FusionCost& cost, const FusionPointOptions& options)
      : mesh_(mesh), cost_(cost), options_(options) {}

  /// The unconstrained minimum of the prey's quadric, and the cost there: what the queue is ordered by.
  struct Ideal {
    Vector3 offset{};  ///< from prey.vertex[0]
    double cost = 0;
  };
  [[nodiscard]] Ideal ideal(const Prey& prey) const;

  /// REQUIRES: test.gather(prey) was true.
  [[nodiscard]] std::optional<FusionPoint> find(const Prey& prey, const FusionTest& test);

 private:
  struct Deciding {
    std::array<VertexId, 4> vertex{};
    std::size_t count = 0;
    bool boundary = false;
    Vector3 centre{};  // relative to prey.vertex[0]
  };
  struct Choice {
    LatticePoint point;
    double cost;
    double dearness;  // what the cost is multiplied by when choices are compared
  };

  [[nodiscard]] Deciding deciding(const Prey& prey) const;
  [[nodiscard]] Ideal idealOf(const Prey& prey, const Deciding& deciding, const PreyQuadric& of) const;
  void offer(const LatticePoint& p, double dearness = 1);
  void offerChoices(const Prey& prey, const FusionTest& test);
  void offerFree(const Prey& prey, const Deciding& deciding, const PreyQuadric& of, const FusionTest& test);

  const FusionMesh& mesh_;
  const FusionCost& cost_;
  FusionPointOptions options_;
  Quadric quadric_;
  Vector3 origin_{};
  std::vector<Choice> choices_;
};

}  // namespace qtet
