#include "simplify/series/time_differences.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "codec/mesh/time_prediction.h"
#include "simplify/clean/quantise_field.h"
#include "simplify/mesh/moved_place.h"
#include "simplify/mesh/tet_mesh.h"
#include "simplify/series/series.h"
#include "simplify/series/time_weights.h"

namespace qtet {
namespace {

std::int32_t predictedAt(const FusionHistory& history, const TimePrediction& prediction,
                         std::size_t i) {
  return static_cast<std::int32_t>(predictInTime(
      prediction, [&](std::uint16_t parent) { return history.values[parent][i]; }, kMissing));
}

std::int32_t differenceOf(const FusionHistory& history, std::size_t f,
                          const TimePrediction& prediction, std::size_t i) {
  const std::int32_t value = history.values[f][i];
  if (value == kMissing || prediction.isNone()) return value;
  assert(prediction.parents[0].field < f);
  return value - predictedAt(history, prediction, i);
}

// A choice looks at so many fusions or cells, evenly spread. So its time does not grow with the
// mesh.
constexpr std::size_t kMaxLookedAt = 1 << 14;

/// Calls visit(i, j) for places in the field's values: about what is coded is the value at i less
/// that at j. They are a prey vertex and its fused vertex, or a cell and the one before.
template <class Visit>
void eachPair(const FusionHistory& history, std::size_t f, const Visit& visit) {
  const std::size_t n = history.fields[f].components;
  const bool ofCells = isCellField(history.fields[f]);
  const std::size_t count = ofCells ? history.values[f].size() / n : history.fusions.size();
  const std::size_t step = count / kMaxLookedAt + 1;
  for (std::size_t at = ofCells ? 1 : 0; at < count; at += step) {
    if (ofCells) {
      for (std::size_t c = 0; c < n; ++c) visit(at * n + c, (at - 1) * n + c);
      continue;
    }
    const Fusion& fusion = history.fusions[at];
    for (std::size_t i = 0; i < fusion.k; ++i)
      for (std::size_t c = 0; c < n; ++c) visit(fusion.prey[i] * n + c, fusion.fused * n + c);
  }
}

class Chooser {
 public:
  Chooser(FusionHistory& history, const Series& series, std::span<const std::size_t> rows)
      : history_(history), series_(series), rows_(rows) {}

  void choose(const InstantStep& step) {
    assert(step.instant < series_.fields.size());
    f_ = series_.fields[step.instant];
    if (f_ < rows_.size()) {
      anchorsInARow_ = rows_[f_];
      return;
    }
    // with more a difference could leave what a value block holds
    if (history_.fields[f_].bits > kMaxScaleBits) return;
    best_ = {};
    least_ = bitsOf(best_);
    if (step.isAnchor)
      tryBefore(step);
    else
      tryAround(step);
    history_.fields[f_].prediction = best_;
  }

 private:
  void tryBefore(const InstantStep& step) {
    anchorsInARow_ = anchorsInARow_ + 1 < kAnchorsInARow ? anchorsInARow_ + 1 : 0;
    if (anchorsInARow_ > 0) tryOut(step.around, step.instant);
    // the anchor before rests on the one before that, so it is decoded anyway
    if (anchorsInARow_ > 1 && step.around[0] >= kWindow)
      tryOut({step.around[0], step.around[0] - kWindow}, step.instant);
    if (best_.isNone()) anchorsInARow_ = 0;
  }

  void tryAround(const InstantStep& step) {
    const auto right = std::ranges::lower_bound(step.around, step.instant);
    assert(right != step.around.begin() && right != step.around.end());
    const std::size_t before = *(right - 1), after = *right;
    const double time = series_.times[step.instant];
    const bool isLeft = time - series_.times[before] <= series_.times[after] - time;
    tryOut({isLeft ? before : after}, step.instant);
    tryOut({before, after}, step.instant);
    if (step.around.size() > 2) tryOut(step.around, step.instant);
  }

  /// Prediction from those of these instants that have the same scale, if all come before.
  void tryOut(const std::vector<std::size_t>& instants, std::size_t instant) {
    std::vector<double> times;
    std::vector<std::uint16_t> parents;
    for (const std::size_t i : instants) {
      const std::size_t parent = series_.fields[i];
      if (parent >= f_) return;
      if (!haveOneScale(history_.fields[parent], history_.fields[f_])) continue;
      parents.push_back(static_cast<std::uint16_t>(parent));
      times.push_back(series_.times[i]);
    }
    if (parents.empty()) return;
    tryWeights(parents, polynomialWeights(times, series_.times[instant]));
    const std::vector<double> even = fitted(parents, WeightFit(parents.size()));
    tryWeights(parents, even);
    tryWeights(parents, fitted(parents, WeightFit(even)));
  }

  void tryWeights(std::span<const std::uint16_t> parents, std::span<const double> weights) {
    assert(weights.size() == parents.size());
    const std::vector<int> rounded = roundedWeights(weights);
    TimePrediction prediction;
    for (std::size_t i = 0; i < rounded.size(); ++i)  // one that counts nothing need not be fetched
      if (rounded[i] != 0)
        prediction.parents[prediction.count++] = {parents[i], static_cast<std::int8_t>(rounded[i])};
    if (prediction.isNone()) return;
    if (const std::uint64_t bits = bitsOf(prediction); bits < least_)
      least_ = bits, best_ = prediction;
  }

  [[nodiscard]] std::vector<double> fitted(std::span<const std::uint16_t> parents,
                                           WeightFit fit) const {
    assert(!parents.empty() && parents.size() <= TimePrediction::kMaxParents);
    std::array<double, TimePrediction::kMaxParents> row{};
    eachPair(history_, f_, [&](std::size_t i, std::size_t j) {
      bool isMissing = false;
      const auto change = [&](std::size_t field) {
        const std::int32_t a = history_.values[field][i], b = history_.values[field][j];
        isMissing |= a == kMissing || b == kMissing;
        return static_cast<double>(a) - b;
      };
      for (std::size_t p = 0; p < parents.size(); ++p) row[p] = change(parents[p]);
      const double target = change(f_);
      if (!isMissing) fit.add(std::span(row).first(parents.size()), target);
    });
    return fit.solve();
  }

  /// About the bits that the field takes.
  [[nodiscard]] std::uint64_t bitsOf(const TimePrediction& prediction) const {
    std::uint64_t bits = 0;
    eachPair(history_, f_, [&](std::size_t i, std::size_t j) {
      const std::int32_t a = differenceOf(history_, f_, prediction, i),
                         b = differenceOf(history_, f_, prediction, j);
      if (a == kMissing || b == kMissing) return;
      bits += static_cast<std::uint64_t>(
          std::bit_width(static_cast<std::uint32_t>(std::abs(std::int64_t{a} - b))));
    });
    return bits;
  }

  FusionHistory& history_;
  const Series& series_;
  std::span<const std::size_t> rows_;
  std::size_t f_ = 0;  // the field that is predicted
  TimePrediction best_;
  std::uint64_t least_ = 0;
  std::size_t anchorsInARow_ = 0;
};

}  // namespace

Result<std::size_t> predictInTime(FusionHistory& history, const std::stop_token& stop,
                                  const std::function<void(double)>& progress,
                                  std::span<const std::size_t> rows) {
  const std::vector<Series> all = seriesOf(history.fields);
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
  return std::ranges::count_if(history.fields,
                               [](const FieldInfo& f) { return !f.prediction.isNone(); });
}

std::vector<std::int32_t> predictedValues(const FusionHistory& history, std::size_t field) {
  std::vector<std::int32_t> out;
  const TimePrediction& prediction = history.fields[field].prediction;
  if (prediction.isNone()) return out;
  out.reserve(history.values[field].size());
  for (std::size_t i = 0; i < history.values[field].size(); ++i)
    out.push_back(predictedAt(history, prediction, i));
  return out;
}

void toTimeDifferences(FusionHistory& history) {
  for (std::size_t f = history.fields.size(); f-- > 0;) {  // parents keep their values until then
    const TimePrediction& prediction = history.fields[f].prediction;
    if (prediction.isNone()) continue;
    for (std::size_t i = 0; i < history.values[f].size(); ++i)
      history.values[f][i] = differenceOf(history, f, prediction, i);
  }
}

}  // namespace qtet
