#include "simplify/log/lift_fields.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

#include "proto/series.h"
#include "simplify/measure/measure_error.h"
#include "simplify/mesh/missing_values.h"
#include "simplify/mesh/tet_mesh.h"
#include "simplify/series/time_differences.h"

namespace qtet {
namespace {

/// By how much corrections count, from wide to narrow. The first figure is for levels with at most
/// a quarter of the cells: so many times their known error. It is twice that up to 60 % of the
/// cells, and four times up to `end`. Finer levels have none. Instants of a series take the first
/// figure everywhere: they are most of their log.
struct Width {
  double errors, end;
};
constexpr std::array<Width, 9> kWidths{{{4, 0.8},
                                        {2.8, 0.8},
                                        {2, 0.8},
                                        {1.4, 0.8},
                                        {1, 0.8},
                                        {0.7, 0.9},
                                        {0.5, 1},
                                        {0.35, 1},
                                        {0.25, 1}}};
/// The first that is tried: S5 of the measurements (HISTORY.md, "Values once").
constexpr std::size_t kFirstWidth = 4;
constexpr double kQuarter = 0.25, kHalf = 0.5, kMiddle = 0.6;
/// Small corrections of an instant stay where they count less than so many steps.
constexpr double kMinSkipped = 0.25;

/// The cells of each level over those of the finest.
std::vector<double> sharesOfCells(const FusionHistory& history) {
  std::vector<double> out(history.levels + std::size_t{1});
  const auto isTetrahedron = [&](std::uint32_t cell) { return history.cells[cell][3] != kGhost; };
  std::vector<std::uint64_t> removed(out.size());
  for (const Fusion& fusion : history.fusions)
    for (std::uint32_t i = 0; i < fusion.deletedCount; ++i)
      removed[history.levels - 1 - fusion.level] +=
          isTetrahedron(history.deletedCells[fusion.firstDeleted + i]) ? 1 : 0;
  const auto all = static_cast<double>(
      std::ranges::count_if(history.cells, [](const Tetrahedron& t) { return t[3] != kGhost; }));
  double left = all;
  for (std::size_t level = out.size(); level-- > 0;) {
    left -= static_cast<double>(removed[level]);
    assert(left > 0);
    out[level] = left / all;
  }
  return out;
}

/// The known error of each level, `steps` times; between those that were measured it is a geometric
/// row. Empty: no level has one.
std::vector<double> errorsInSteps(const LevelErrors& errors, std::size_t field, double steps) {
  std::vector<std::pair<std::size_t, double>> known;
  for (std::size_t level = 0; level < errors.size(); ++level)
    if (errors[level] && errors[level]->fields[field].rms > 0)
      known.emplace_back(level, std::log(errors[level]->fields[field].rms * steps));
  if (known.empty()) return {};
  std::vector<double> out;
  std::size_t next = 0;
  for (std::size_t level = 0; level < errors.size(); ++level) {
    while (next < known.size() && known[next].first < level) ++next;
    const auto& finer = known[std::min(next, known.size() - 1)];
    const auto& coarser = known[next == 0 ? 0 : std::min(next, known.size()) - 1];
    const double share = finer.first <= coarser.first
                             ? 0
                             : std::clamp(static_cast<double>(level - coarser.first) /
                                              static_cast<double>(finer.first - coarser.first),
                                          0.0, 1.0);
    out.push_back(std::exp(coarser.second + share * (finer.second - coarser.second)));
  }
  return out;
}

/// The power of two nearest to a number of steps.
int shiftOf(double steps) {
  return std::clamp(static_cast<int>(std::floor(std::log2(std::max(steps, 1.0)) + 0.5)), 0,
                    LiftingRule::kMaxShift);
}

void fillFrom(const std::vector<std::int32_t>& filled, std::vector<std::int32_t>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] == kMissing) values[i] = filled[i];
}

class Lifter {
 public:
  Lifter(FusionHistory& history, const ValueOrder& order, LevelErrors& errors,
         const LiftOptions& options)
      : history_(history),
        order_(order),
        errors_(errors),
        options_(options),
        cells_(sharesOfCells(history)) {
    std::vector<std::uint32_t> levelOf(history.points.size());
    for (const Fusion& fusion : history.fusions) levelOf[fusion.fused] = fusion.level;
    for (const std::uint32_t birth : order.points.levelStarts())
      levels_.push_back(history.levels - 1 - levelOf[order.fused[birth]]);
  }

  /// Leaves the values as the log has them. `filled`: the same with a number everywhere.
  LiftingRules lift(std::size_t f, const std::vector<std::int32_t>& filled) {
    const std::vector<std::int32_t> predicted = predictedValues(history_, f);
    if (movesMeasured(f)) {
      const std::vector<std::int32_t> wanted = history_.values[f];
      const Figures before = errorsOf(f, filled);
      std::optional<Lifted> best;
      std::size_t width = width_,
                  failed = kWidths.size();  // wider than the failed one none is tried
      while (width < kWidths.size()) {
        history_.values[f] = wanted;
        Lifted lifted{width, lift(f, predicted, stepsOf(f, width)), errorsOf(f, filled), {}};
        const double grown = growthOf(f, before, lifted.errors);
        const int halvings = static_cast<int>(std::floor(-std::log2(std::max(grown, 1.0 / 16))));
        if (grown <= 1) {
          lifted.values = std::move(history_.values[f]);
          best = std::move(lifted);
          // what the error grows by is as the square of the width
          const std::size_t wider = width - std::min<std::size_t>(width, std::max(halvings, 0));
          if (wider == width || (failed < kWidths.size() && wider <= failed)) break;
          width = wider;
        } else {
          failed = width;
          if (best) break;
          width += static_cast<std::size_t>(std::max(-halvings, 1));
        }
      }
      if (best) {
        width_ = best->width;
        history_.values[f] = std::move(best->values);
        setFieldErrors(*options_.replay, best->errors, f - options_.firstField, errors_);
        return std::move(best->rules);
      }
      history_.values[f] = wanted;
    }
    const bool stays = options_.replay != nullptr || !isFloatType(history_.fields[f].type);
    return lift(f, predicted,
                std::vector<LevelStep>(levels_.size(), {stays ? 0 : options_.unmeasuredShift}));
  }

 private:
  using Figures = std::vector<FieldError>;
  struct Lifted {
    std::size_t width;
    LiftingRules rules;
    Figures errors;
    std::vector<std::int32_t> values;
  };

  [[nodiscard]] bool movesMeasured(std::size_t f) const {
    return options_.replay != nullptr && isFloatType(history_.fields[f].type) &&
           options_.replay->ranges[f - options_.firstField] > 0 &&
           std::ranges::find(options_.exact, f) == options_.exact.end();
  }
  LiftingRules lift(std::size_t f, const std::vector<std::int32_t>& predicted,
                    const std::vector<LevelStep>& steps) {
    const FieldInfo& field = history_.fields[f];
    std::vector<std::int32_t>& values = history_.values[f];
    for (std::size_t i = 0; i < predicted.size(); ++i)
      if (values[i] != kMissing) values[i] -= predicted[i];
    LiftingRules rules =
        liftField(order_, {field.components, field.hasMissing, values, predicted}, steps);
    for (std::size_t i = 0; i < predicted.size(); ++i)
      if (values[i] != kMissing) values[i] += predicted[i];
    return rules;
  }
  /// With missing values filled in.
  [[nodiscard]] Figures errorsOf(std::size_t f, const std::vector<std::int32_t>& filled) {
    if (filled.empty()) return options_.replay->errors(history_, f, options_.firstField);
    std::vector<std::int32_t> whole = history_.values[f];
    fillFrom(filled, whole);
    std::swap(whole, history_.values[f]);
    Figures out = options_.replay->errors(history_, f, options_.firstField);
    std::swap(whole, history_.values[f]);
    return out;
  }
  /// By how much the rms has grown at most, over the growth that is allowed; above 1 is too much.
  [[nodiscard]] double growthOf(std::size_t f, const Figures& before, const Figures& after) const {
    const double steps = stepsIn(f);
    double out = 0, finerCells = 1, finerGrowth = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const std::uint32_t coarser = options_.replay->levels[i].coarser;
      if (coarser >= cells_.size()) break;
      const double cells = cells_[cells_.size() - 1 - coarser];
      const double growth = before[i].rms > 0 ? after[i].rms / before[i].rms - 1 : 0;
      const bool isSmall = before[i].rms * steps < kSmallSteps;
      const auto most = [&](double usual) { return (isSmall ? kMostSmallGrowth : usual) - 1; };
      out = std::max(out, growth / most(cells <= kQuarter ? kMostGrowth
                                        : cells <= kHalf  ? kMostHalfGrowth
                                                          : kMostFineGrowth));
      if (cells < kHalf && finerCells > kHalf) {  // at half itself, between the two levels
        const double share = std::log(kHalf / finerCells) / std::log(cells / finerCells);
        out = std::max(out, (finerGrowth + share * (growth - finerGrowth)) / most(kMostHalfGrowth));
      }
      finerCells = cells, finerGrowth = growth;
    }
    return out;
  }
  /// The steps that an error of 1 has, by component.
  [[nodiscard]] double stepsIn(std::size_t f) const {
    return options_.replay->ranges[f - options_.firstField] /
           std::sqrt(static_cast<double>(history_.fields[f].components));
  }

  [[nodiscard]] std::vector<LevelStep> stepsOf(std::size_t f, std::size_t width) const {
    std::vector<LevelStep> out(levels_.size());
    const std::vector<double> errors = errorsInSteps(errors_, f - options_.firstField, stepsIn(f));
    if (errors.empty()) return out;
    const bool isInstant = history_.fields[f].name.isInstant();
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double cells = isInstant ? 0 : cells_[levels_[i]];
      const double times = cells < kQuarter ? 1 : cells < kMiddle ? 2 : 4;
      const double wanted = times * kWidths[width].errors * errors[levels_[i]];
      out[i].shift = cells < kWidths[width].end ? shiftOf(wanted) : LiftingRule::kNoCorrection;
      if (isInstant && wanted >= kMinSkipped) out[i].skips = Skips::kSmall;
    }
    return out;
  }

  FusionHistory& history_;
  const ValueOrder& order_;
  LevelErrors& errors_;
  const LiftOptions& options_;
  const std::vector<double> cells_;
  std::vector<std::size_t> levels_;  // where the fused values of each level with records stand
  std::size_t width_ = kFirstWidth;  // of the field before
};

}  // namespace

Result<std::vector<LiftingRules>> liftFields(FusionHistory& history, const ValueOrder& order,
                                             LevelErrors& errors, const LiftOptions& options) {
  std::vector<LiftingRules> out(history.fields.size());
  std::vector<std::vector<std::int32_t>> filled(out.size());
  Lifter lifter(history, order, errors, options);
  for (std::size_t f = options.firstField; f < out.size(); ++f) {
    if (options.stop.stop_requested()) return cancelled();
    const std::size_t number = f - options.firstField;
    if (number < options.missing.size() && !options.missing[number].empty()) {
      filled[f] = history.values[f];
      history.values[f] = withMissing(history, history.fields[f], options.missing[number],
                                      std::move(history.values[f]));
    }
    if (!isCellField(history.fields[f])) out[f] = lifter.lift(f, filled[f]);
  }
  for (std::size_t f = 0; f < out.size(); ++f)
    if (!filled[f].empty()) fillFrom(filled[f], history.values[f]);
  return out;
}

}  // namespace qtet
