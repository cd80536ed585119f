#include "simplify/series/time_weights.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace qtet {
namespace {

// Decides between weights that the rows leave open: those nearest to the weights before, by this
// share of the rows.
constexpr double kPull = 1e-9;
// Keeps the diagonal above 0 where all values are equal.
constexpr double kMinPull = 1e-3;

// Where the sum of the weights is so near to 1, a constant should predict itself.
constexpr double kNearlyOne = 1.0 / 32;

}  // namespace

std::vector<double> polynomialWeights(std::span<const double> times, double time) {
  std::vector<double> out;
  for (std::size_t i = 0; i < times.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < times.size(); ++j) {
      assert(j == i || times[i] != times[j]);
      if (j != i) weight *= (time - times[j]) / (times[i] - times[j]);
    }
    out.push_back(weight);
  }
  return out;
}

void WeightFit::add(std::span<const double> parents, double target) {
  assert(parents.size() == weights_.size());
  double miss = target;
  for (std::size_t i = 0; i < parents.size(); ++i) miss -= weights_[i] * parents[i];
  const double root = isEven_ ? 1 : 1 + std::fabs(miss), counts = 1 / (root * root);
  for (std::size_t i = 0; i < parents.size(); ++i) {
    for (std::size_t j = 0; j < parents.size(); ++j)
      sums_[i][j] += counts * parents[i] * parents[j];
    sums_[i].back() += counts * parents[i] * miss;
  }
}

// Gauss and Jordan on what is to be added to the weights: a symmetric matrix that the pull makes
// positive needs no pivots. One of zeros alone leaves the weights as they are.
std::vector<double> WeightFit::solve() const {
  auto sums = sums_;
  const std::size_t n = weights_.size();
  for (std::size_t i = 0; i < n; ++i) sums[i][i] += kPull * sums[i][i] + kMinPull;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t row = 0; row < n; ++row) {
      if (row == i) continue;
      assert(sums[i][i] > 0);
      const double share = sums[row][i] / sums[i][i];
      for (std::size_t j = 0; j < n; ++j) sums[row][j] -= share * sums[i][j];
      sums[row].back() -= share * sums[i].back();
    }
  std::vector<double> out = weights_;
  for (std::size_t i = 0; i < n; ++i) out[i] += sums[i].back() / sums[i][i];
  return out;
}

std::vector<int> roundedWeights(std::span<const double> weights) {
  std::vector<int> out;
  for (const double weight : weights) {
    const double scaled = std::round(weight * TimePrediction::kOne);
    if (!(std::fabs(scaled) <= std::numeric_limits<std::int8_t>::max())) return {};
    out.push_back(static_cast<int>(scaled));
  }
  if (std::fabs(std::accumulate(weights.begin(), weights.end(), -1.0)) < kNearlyOne) {
    const auto largest = std::ranges::max_element(out, {}, [](int w) { return std::abs(w); });
    *largest += TimePrediction::kOne - std::accumulate(out.begin(), out.end(), 0);
    if (std::abs(*largest) > std::numeric_limits<std::int8_t>::max()) return {};
  }
  return out;
}

}  // namespace qtet
