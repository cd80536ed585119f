// The integers of the point fields that a fused vertex gets.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simplify/cost/fusion_cost.h"
#include "simplify/mesh/fusion_mesh.h"

namespace qtet {

/// A field in the cost gets what the cost says, another one what the nearest prey vertex has.
class FusedIntegers {
 public:
  /// `values`: FusionCost::valuesAt the point. REQUIRES: all outlive this.
  FusedIntegers(const FusionMesh& mesh, const FusionCost& cost, const Prey& prey,
                const LatticePoint& point, std::span<const double> values);

  /// Component c of a field in the cost, number `component` of all in the cost.
  [[nodiscard]] std::int32_t ofPart(const CostPart& part, std::size_t c,
                                    std::size_t component) const;
  /// The integers of a field that is not in the cost.
  [[nodiscard]] std::span<const std::int32_t> ofOther(std::size_t field) const {
    return mesh_.values(field, nearest_);
  }

 private:
  /// Where the cost's values stand for many components. The fields are the mean of what the prey
  /// vertices have, changed as the values change.
  struct Many {
    std::array<double, 4> shares;
    CostValues change;
  };
  [[nodiscard]] double ofMany(const CostPart& part, std::size_t c, std::size_t component) const;

  const FusionMesh& mesh_;
  const CostBasis& basis_;
  Prey prey_;
  std::span<const double> values_;
  VertexId nearest_;
  std::optional<Many> many_;
};

/// The integers of some point fields alone.
class SomeIntegers {
 public:
  /// REQUIRES: mesh and cost outlive this.
  SomeIntegers(const FusionMesh& mesh, const FusionCost& cost, std::span<const std::size_t> fields);

  /// One field's after the other, as FusedIntegers has them; valid until the next question.
  [[nodiscard]] std::span<const std::int32_t> at(const Prey& prey, const LatticePoint& point);

 private:
  struct Chosen {
    std::size_t field;
    std::optional<CostPart> part;  // empty: not in the cost
    std::size_t component;         // the first one's number in the cost
  };

  const FusionMesh& mesh_;
  const FusionCost& cost_;
  std::vector<Chosen> chosen_;
  std::vector<std::int32_t> integers_;
};

}  // namespace qtet
