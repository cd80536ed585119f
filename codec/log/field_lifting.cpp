#include "codec/log/field_lifting.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "proto/limits.h"

namespace qtet {
namespace {

using PreyValues = std::array<std::int64_t, LiftedRecord::kMaxPrey>;

/// A correction below this share of its unit may be left out.
constexpr double kSkipped = 0.8;

/// Runs over a field's records, the finest level first. `now_` holds the values by slot, as a
/// decoder has them before the record.
class Lifting {
 public:
  Lifting(const ValueOrder& order, const LiftedTarget& field)
      : order_(order), field_(field), ranges_(field.components) {
    std::vector<VertexId> vertices(order.vertices());
    std::ranges::copy(order.baseVertices, vertices.begin());
    const std::span<const Birth> births = order.points.births();
    for (std::size_t b = 0; b < births.size(); ++b)
      for (std::size_t i = 0; i < births[b].k; ++i)
        vertices[births[b].preySlot(i)] = order.prey[b][i];
    now_.reserve(vertices.size() * field.components);
    for (const VertexId v : vertices)
      for (std::uint32_t c = 0; c < field.components; ++c) now_.push_back(field.values[at(v, c)]);
    for (const VertexId v : vertices) count(v);
    for (std::size_t b = 0; b < births.size(); ++b) count(order.fused[b]);
  }

  /// The rule of the level from birth `first` to `end`; its fused values take what it tells.
  LiftingRule lift(std::uint32_t first, std::uint32_t end, const LevelStep& step) {
    LiftingRule rule{step.shift, curveOf(first, end)};
    std::int64_t over = undo(first, end, rule, step.skips);
    // corrections back into the range alone: one unit is enough, so that nearly all are 0
    for (int shift = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(over)));
         over > 0 && shift >= 0; --shift) {
      redo(first, end);
      rule.shift = shift;
      over = undo(first, end, rule, Skips::kAll);
    }
    if (isFollowed_) rule.shift = LiftingRule::kNoCorrection;
    return rule;
  }

 private:
  struct Range {
    std::int64_t least = std::numeric_limits<std::int64_t>::max(),
                 most = std::numeric_limits<std::int64_t>::min();
  };
  struct Pair {
    double off, bent;
  };

  [[nodiscard]] std::size_t at(VertexId v, std::uint32_t c) const {
    return std::size_t{v} * field_.components + c;
  }
  [[nodiscard]] std::int64_t predicted(VertexId v, std::uint32_t c) const {
    return field_.predicted.empty() ? 0 : field_.predicted[at(v, c)];
  }
  void count(VertexId v) {
    for (std::uint32_t c = 0; c < field_.components; ++c) {
      const std::int32_t value = field_.values[at(v, c)];
      if (value == kMissing) continue;
      Range& range = ranges_[c];
      range.least = std::min(range.least, value + predicted(v, c));
      range.most = std::max(range.most, value + predicted(v, c));
    }
  }

  /// Moves the fused values of the level, and undoes its records. How far the worst one leaves the
  /// range.
  std::int64_t undo(std::uint32_t first, std::uint32_t end, const LiftingRule& rule, Skips skips) {
    std::int64_t over = 0;
    isFollowed_ = true;
    for (std::uint32_t b = end; b-- > first;) {
      const LiftedRecord record(order_.points.births()[b],
                                order_.points.slopesAt(order_.points.births()[b]));
      for (std::uint32_t c = 0; c < field_.components; ++c)
        over = std::max(over, undo(b, record, c, rule, skips));
    }
    return over;
  }
  void redo(std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t b = first; b < end; ++b)
      for (std::uint32_t c = 0; c < field_.components; ++c)
        now_[at(order_.points.births()[b].slot, c)] = field_.values[at(order_.prey[b][0], c)];
  }

  std::int64_t undo(std::uint32_t b, const LiftedRecord& record, std::uint32_t c,
                    const LiftingRule& rule, Skips skips) {
    const Birth& birth = record.birth();
    const VertexId vertex = order_.fused[b];
    std::int32_t& fused = field_.values[at(vertex, c)];
    std::int32_t& slot = now_[at(birth.slot, c)];
    PreyValues prey{};
    const std::size_t missing = preyOf(b, c, prey);
    if (missing > 0) {
      isFollowed_ = isFollowed_ && missing == birth.k;
      if (missing == birth.k)
        fused = kMissing;
      else if (!rule.isCorrected())
        fused = firstPresent(prey);
      slot = fused;
      return 0;
    }
    const std::int64_t follows = record.follows(
        rule, prey, [&](VertexId v) -> std::int64_t { return now_[at(v, c)]; }, isWhole(record, c));
    const Range& range = ranges_[c];
    const std::int64_t least = range.least - predicted(vertex, c) - follows,
                       most = range.most - predicted(vertex, c) - follows;
    std::int64_t added = 0;
    if (rule.isCorrected()) {
      const std::int64_t unit = std::int64_t{1} << rule.shift;
      const std::int64_t steps =
          skips == Skips::kAll ? 0 : stepsOf(fused - follows, rule.shift, skips);
      // rounded towards the range's inside; a range narrower than a unit may hold none
      const std::int64_t low = -((-least) >> rule.shift), high = most >> rule.shift;
      added = (low <= high ? std::clamp(steps, low, high) : steps) * unit;
    }
    isFollowed_ = isFollowed_ && added == 0;
    slot = fused = static_cast<std::int32_t>(follows + added);
    return std::max<std::int64_t>({0, least - added, added - most});
  }
  /// The nearest number of units, or less.
  [[nodiscard]] static std::int64_t stepsOf(std::int64_t off, int shift, Skips skips) {
    if (shift == 0) return skips == Skips::kSmall && std::abs(off) == 1 ? 0 : off;
    const double units = std::ldexp(static_cast<double>(std::abs(off)), -shift);
    const auto steps =
        static_cast<std::int64_t>(units + (skips == Skips::kSmall ? 1 - kSkipped : 0.5));
    return off < 0 ? -steps : steps;
  }
  /// How many prey are missing; the others' values are in `prey`, and kMissing.
  std::size_t preyOf(std::uint32_t b, std::uint32_t c, PreyValues& prey) const {
    const std::size_t k = order_.points.births()[b].k;
    prey.fill(kMissing);
    std::size_t missing = 0;
    for (std::size_t i = 0; i < k; ++i) {
      prey[i] = field_.values[at(order_.prey[b][i], c)];
      if (field_.hasMissing && prey[i] == kMissing) ++missing;
    }
    return missing;
  }
  [[nodiscard]] static std::int32_t firstPresent(const PreyValues& prey) {
    for (const std::int64_t x : prey)
      if (x != kMissing) return static_cast<std::int32_t>(x);
    return kMissing;
  }
  [[nodiscard]] bool isWhole(const LiftedRecord& record, std::uint32_t c) const {
    return !field_.hasMissing ||
           record.isWhole([&](VertexId v) { return now_[at(v, c)] != kMissing; });
  }

  /// How much the curvature counts in a level. It fits the fused values' distances to their prey's
  /// means by those of the means to the links. Large distances count less.
  int curveOf(std::uint32_t first, std::uint32_t end) {
    pairs_.clear();
    double sum = 0;
    for (std::uint32_t b = first; b < end; ++b) addPairs(b);
    for (const Pair& pair : pairs_) sum += std::fabs(pair.off);
    const double usual = sum / static_cast<double>(std::max<std::size_t>(pairs_.size(), 1)) + 0.1;
    double up = 0, down = 1e-9;
    for (const Pair& pair : pairs_) {
      const double weight = 1 / (usual + std::fabs(pair.off));
      up += weight * pair.off * pair.bent;
      down += weight * pair.bent * pair.bent;
    }
    return static_cast<int>(
        std::fmin(std::fmax(std::floor(256 * up / down + 0.5), 0), LiftingRule::kMaxCurve));
  }
  void addPairs(std::uint32_t b) {
    const Birth& birth = order_.points.births()[b];
    if (birth.k != 2) return;
    const LiftedRecord record(birth, order_.points.slopesAt(birth));
    const double share = 4.0 * record.along() * (256 - record.along()) / 65536;
    if (share == 0 || record.curveWeight({0, LiftingRule::kMaxCurve}) == 0) return;
    for (std::uint32_t c = 0; c < field_.components; ++c) {
      PreyValues prey{};
      if (preyOf(b, c, prey) > 0 || !isWhole(record, c)) continue;
      const std::int64_t mean = prey[0] + record.mean({0, prey[1] - prey[0]});
      const std::int64_t link =
          record.link([&](VertexId v) -> std::int64_t { return now_[at(v, c)]; });
      const std::int32_t fused = field_.values[at(order_.fused[b], c)];
      pairs_.push_back(
          {static_cast<double>(fused - mean), share * static_cast<double>(mean - link)});
    }
  }

  const ValueOrder& order_;
  const LiftedTarget& field_;
  std::vector<Range> ranges_;  // by component, of whole values
  std::vector<std::int32_t> now_;
  std::vector<Pair> pairs_;
  bool isFollowed_ = false;  // no correction of the level is other than 0
};

}  // namespace

LiftingRules liftField(const ValueOrder& order, const LiftedTarget& field,
                       std::span<const LevelStep> steps) {
  const std::span<const std::uint32_t> starts = order.points.levelStarts();
  assert(steps.size() == starts.size());
  Lifting lifting(order, field);
  LiftingRules out(starts.size());
  auto end = static_cast<std::uint32_t>(order.points.births().size());
  for (std::size_t level = starts.size(); level-- > 0;) {
    out[level] = lifting.lift(starts[level], end, steps[level]);
    end = starts[level];
  }
  return out;
}

LiftingRules exactRules(const ValueOrder& order, const FieldInfo& field,
                        std::span<const std::int32_t> values) {
  std::vector<std::int32_t> copy(values.begin(), values.end());
  const std::vector<LevelStep> steps(order.points.levelStarts().size());
  return liftField(order, {field.components, field.hasMissing, copy}, steps);
}

}  // namespace qtet
