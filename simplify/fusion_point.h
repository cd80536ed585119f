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

class FusionPointFinder {
 public:
  FusionPointFinder(const FusionMesh& mesh, const FusionCost& cost, double shapeWeight)
      : mesh_(mesh), cost_(cost), shapeWeight_(shapeWeight) {}

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
    double cost; double factor;
  };

  [[nodiscard]] Deciding deciding(const Prey& prey) const;
  [[nodiscard]] Ideal idealOf(const Prey& prey, const Deciding& deciding, const PreyQuadric& of) const;
  void offer(const LatticePoint& p);
  void offerChoices(const Prey& prey, const FusionTest& test);

  const FusionMesh& mesh_;
  const FusionCost& cost_;
  double shapeWeight_; double factor_ = 1;
  Quadric quadric_;
  Vector3 origin_{};
  std::vector<Choice> choices_;
};

}  // namespace qtet
