#include "simplify/series/time_differences.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>
#include <vector>

#include "simplify/clean/quantise_field.h"
#include "simplify/series/series.h"

namespace qtet {
namespace {

std::int32_t differenceOf(const FusionHistory& history, std::size_t f,
                          const TimePrediction& prediction, std::size_t i) {
  const std::int32_t value = history.values[f][i];
  if (value == kMissing || prediction.isNone()) return value;
  return static_cast<std::int32_t>(
      value - prediction.predict([&](std::uint16_t parent) { return history.values[parent][i]; },
                                 kMissing));
}

/// About the bits that the field takes: those of what a prey vertex has beyond its fused vertex, or
/// a cell beyond the one before.
std::uint64_t bitsOf(const FusionHistory& history, std::size_t f,
                     const TimePrediction& prediction) {
  const std::size_t n = history.fields[f].components;
  std::uint64_t bits = 0;
  const auto count = [&](std::size_t element, std::size_t from) {
    for (std::size_t c = 0; c < n; ++c) {
      const std::int32_t a = differenceOf(history, f, prediction, element * n + c),
                         b = differenceOf(history, f, prediction, from * n + c);
      if (a == kMissing || b == kMissing) continue;
      bits += static_cast<std::uint64_t>(
          std::bit_width(static_cast<std::uint32_t>(std::abs(std::int64_t{a} - b))));
    }
  };
  if (isCellField(history.fields[f])) {
    for (std::size_t t = 1; t < history.values[f].size() / n; ++t) count(t, t - 1);
  } else {
    for (const Fusion& fusion : history.fusions)
      for (std::size_t i = 0; i < fusion.k; ++i) count(fusion.prey[i], fusion.fused);
  }
  return bits;
}

/// The value at `time` of the polynomial through the values at `times`, as weights of these.
std::vector<double> lagrange(std::span<const double> times, double time) {
  std::vector<double> out;
  for (std::size_t i = 0; i < times.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < times.size(); ++j)
      if (j != i) weight *= (time - times[j]) / (times[i] - times[j]);
    out.push_back(weight);
  }
  return out;
}

/// Equal integers of both are equal values.
bool haveOneScale(const FieldInfo& a, const FieldInfo& b) {
  return a.step == b.step && a.minimum == b.minimum;
}

class Chooser {
 public:
  Chooser(FusionHistory& history, const Series& series, std::span<const std::size_t> rows)
      : history_(history), series_(series), rows_(rows) {}

  void choose(const InstantStep& step) {
    const std::size_t f = series_.fields[step.instant];
    if (f < rows_.size()) {
      anchorsInARow_ = rows_[f];
      return;
    }
    // with more a difference could leave what a value block holds
    if (history_.fields[f].bits > kMostScaleBits) return;
    best_ = {};
    least_ = bitsOf(history_, f, best_);
    if (step.isAnchor) {
      anchorsInARow_ = anchorsInARow_ + 1 < kAnchorsInARow ? anchorsInARow_ + 1 : 0;
      if (anchorsInARow_ > 0) tryOut(f, step.around, step.instant);
      if (best_.isNone()) anchorsInARow_ = 0;
    } else {
      tryAround(f, step);
    }
    history_.fields[f].prediction = best_;
  }

 private:
  void tryAround(std::size_t f, const InstantStep& step) {
    const auto right = std::ranges::lower_bound(step.around, step.instant);
    const std::size_t before = *(right - 1), after = *right;
    const double time = series_.times[step.instant];
    const bool isLeft = time - series_.times[before] <= series_.times[after] - time;
    tryOut(f, {isLeft ? before : after}, step.instant);
    tryOut(f, {before, after}, step.instant);
    if (step.around.size() > 2) tryOut(f, step.around, step.instant);
  }

  /// Prediction from these instants, if all are fields that come before and the weights fit.
  void tryOut(std::size_t f, const std::vector<std::size_t>& instants, std::size_t instant) {
    std::vector<double> times;
    for (const std::size_t i : instants) times.push_back(series_.times[i]);
    const std::vector<double> shares = lagrange(times, series_.times[instant]);
    TimePrediction prediction;
    int rest = TimePrediction::kOne;
    for (std::size_t i = 0; i < instants.size(); ++i) {
      const std::size_t parent = series_.fields[instants[i]];
      const auto weight = static_cast<int>(std::lround(shares[i] * TimePrediction::kOne));
      if (parent >= f || !haveOneScale(history_.fields[parent], history_.fields[f]) ||
          std::abs(weight) > 4 * TimePrediction::kOne)
        return;
      rest -= weight;
      prediction.parents[prediction.count++] = {static_cast<std::uint16_t>(parent),
                                                static_cast<std::int8_t>(weight)};
    }
    // what rounding leaves goes to the largest
    const auto largest = std::ranges::max_element(
        prediction.parents, {}, [](const TimePrediction::Parent& p) { return std::abs(p.weight); });
    largest->weight = static_cast<std::int8_t>(largest->weight + rest);
    if (const std::uint64_t bits = bitsOf(history_, f, prediction); bits < least_)
      least_ = bits, best_ = prediction;
  }

  FusionHistory& history_;
  const Series& series_;
  std::span<const std::size_t> rows_;
  TimePrediction best_;
  std::uint64_t least_ = 0;
  std::size_t anchorsInARow_ = 0;
};

}  // namespace

Result<std::size_t> toTimeDifferences(FusionHistory& history, const std::stop_token& stop,
                                      const std::function<void(double)>& progress,
                                      std::span<const std::size_t> rows) {
  const std::vector<Series> all = seriesOf(std::span<const FieldInfo>(history.fields));
  std::size_t instants = 0, done = 0;
  for (const Series& series : all) instants += series.fields.size();
  for (const Series& series : all) {
    Chooser chooser(history, series, rows);
    for (const InstantStep& step : decodingOrder(series.fields.size())) {
      if (stop.stop_requested()) return cancelled();
      chooser.choose(step);
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(instants));
    }
  }
  std::size_t count = 0;
  for (std::size_t f = history.fields.size(); f-- > 0;) {  // parents keep their values until then
    const TimePrediction& prediction = history.fields[f].prediction;
    if (prediction.isNone()) continue;
    if (stop.stop_requested()) return cancelled();
    ++count;
    for (std::size_t i = 0; i < history.values[f].size(); ++i)
      history.values[f][i] = differenceOf(history, f, prediction, i);
  }
  return count;
}

}  // namespace qtet
