// How much each of several instants counts in a prediction of another one.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "codec/mesh/time_parents.h"

namespace qtet {

/// The value at `time` of the polynomial through the values at `times`, as weights of these. They
/// add up to 1. REQUIRES: no two times are equal.
[[nodiscard]] std::vector<double> polynomialWeights(std::span<const double> times, double time);

/// Fits weights by least squares.
class WeightFit {
 public:
  /// All rows count the same. REQUIRES: 1 to TimePrediction::kMaxParents.
  explicit WeightFit(std::size_t parents) : weights_(parents, 0.0) {
    assert(parents >= 1 && parents <= TimePrediction::kMaxParents);
  }
  /// A row counts the less the further the weights of a fit before miss it. So a few large misses
  /// do not outweigh many small ones, as they do not in bits.
  explicit WeightFit(std::vector<double> before) : weights_(std::move(before)), isEven_(false) {}

  /// One row: the parents' values and the value that they should predict.
  void add(std::span<const double> parents, double target);
  /// The weights that fit best.
  [[nodiscard]] std::vector<double> solve() const;

 private:
  static constexpr std::size_t kMax = TimePrediction::kMaxParents;

  std::vector<double> weights_;
  bool isEven_ = true;
  std::array<std::array<double, kMax + 1>, kMax> sums_{};  // normal equations
};

/// The weights in 1 / TimePrediction::kOne. Where they add up to nearly 1, the integers do exactly:
/// equal values then predict themselves. Empty if one does not fit its integer.
[[nodiscard]] std::vector<int> roundedWeights(std::span<const double> weights);

}  // namespace qtet
