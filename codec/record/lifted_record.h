// The part of a record that a lifted point field knows before its values are coded (VALUES.md,
// "Lifted blocks"). It has the guesses that follow from slopes, and the fused value that follows
// from its prey.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "codec/coding/guessed_integer.h"
#include "codec/mesh/mesh.h"
#include "codec/record/point_values.h"
#include "proto/limits.h"

namespace qtet {

/// How the fused values of a level follow from their prey.
struct LiftingRule {
  static constexpr int kNoCorrection = -1, kMaxShift = 30, kMaxCurve = 127;

  /// Corrections count 2^shift; kNoCorrection: there are none.
  int shift = 0;
  /// How much the field's curvature counts, in 1/256.
  int curve = 0;

  [[nodiscard]] bool isCorrected() const { return shift != kNoCorrection; }
};

/// A slope in one component: sums of weight * (the corner's value - another), on both sides.
struct Rise {
  std::array<std::int64_t, 2> side{};  ///< against the step, along it
};

/// The part of a slope that is the same for any component.
struct SlopeSides {
  std::array<std::int64_t, 2> reach{};
  /// One side's rise times this, in 1/256, is the change over a step as that side alone tells it.
  std::array<std::int64_t, 2> ratio{};
  bool hasBoth = false, isBeyond = false;

  SlopeSides() = default;
  explicit SlopeSides(const Slope& slope)
      : reach{slope.reachOf(0), slope.reachOf(1)},
        ratio{slope.ratio(0), slope.ratio(1)},
        hasBoth(slope.hasBoth()),
        isBeyond(slope.isBeyond(0) || slope.isBeyond(1)) {}
  /// The field's curvature shows within the mesh only.
  [[nodiscard]] bool showsCurve() const { return hasBoth && !isBeyond; }
};

namespace lifting {

inline constexpr int kChangeBits = Slope::kWeightBits + Slope::kReachBits;

[[nodiscard]] constexpr std::int64_t rounded(std::int64_t x, int bits) {
  return (x + (std::int64_t{1} << (bits - 1))) >> bits;
}
/// The fused value that `mean` gives with a curvature's weight v.
[[nodiscard]] constexpr std::int64_t lifted(std::int64_t mean, std::int64_t link, std::int64_t v) {
  return mean + rounded((mean - link) * v, 8);
}
/// The greatest mean that gives no more than `value`.
[[nodiscard]] constexpr std::int64_t meanOf(std::int64_t value, std::int64_t link, std::int64_t v) {
  if (v == 0) return value;
  std::int64_t mean = link + 256 * (value - link) / (256 + v);
  while (lifted(mean, link, v) > value) --mean;
  while (lifted(mean + 1, link, v) <= value) ++mean;
  return mean;
}

}  // namespace lifting

/// The part of a record that is known before its values are coded.
class LiftedRecord {
 public:
  static constexpr std::size_t kMaxPrey = 4;

  /// The reaches, which all components share.
  LiftedRecord(const Birth& birth, std::span<const Slope> slopes) : birth_(birth), slopes_(slopes) {
    for (const Slope& slope : slopes) {
      sides_[count_++] = SlopeSides(slope);
      isBeyond_ = isBeyond_ || sides_[count_ - 1].isBeyond;
      hasBoth_ = hasBoth_ && sides_[count_ - 1].hasBoth;
    }
    along_ = std::clamp(-int{birth.step}, 0, 1 << Birth::kStepBits);
  }
  [[nodiscard]] const Birth& birth() const { return birth_; }
  [[nodiscard]] std::span<const Slope> slopes() const { return slopes_; }
  [[nodiscard]] bool isBeyond() const { return isBeyond_; }
  [[nodiscard]] bool hasBoth() const { return hasBoth_; }

  /// How prey 1, 2, 3 differ from prey 0, as the slopes tell it.
  struct Guess {
    std::array<std::int64_t, kMaxPrey> difference{};  ///< the first is 0
    std::array<std::int64_t, kMaxPrey> plain{};       ///< by both sides alike
    bool hasBoth = false;
  };
  /// One a slope, in one component. The others are 0.
  using Rises = std::array<Rise, kMaxPrey>;

  /// From all exits. `rises`: to the fused value.
  [[nodiscard]] Guess guess(const Rises& rises) const {
    Guess out;
    out.hasBoth = hasBoth_;
    std::array<std::int64_t, kMaxPrey> step{}, plain{};
    for (std::size_t i = 0; i < count_; ++i) {
      const Rise& rise = rises[i];
      plain[i] = lifting::rounded(256 * (rise.side[0] + rise.side[1]), lifting::kChangeBits);
      step[i] = sides_[i].hasBoth ? blended(sides_[i], rise) : plain[i];
    }
    spread(step, out.difference);
    spread(plain, out.plain);
    return out;
  }
  /// From the exits within the mesh alone.
  [[nodiscard]] Guess guessWithin(const Rises& rises) const {
    Guess out;
    std::array<std::int64_t, kMaxPrey> step{};
    for (std::size_t i = 0; i < count_; ++i) step[i] = within(slopes_[i], sides_[i], rises[i]);
    spread(step, out.difference);
    out.plain = out.difference;
    return out;
  }
  /// How far the two sides of the slopes disagree, at most, in half values.
  [[nodiscard]] std::uint64_t bend(const Rises& rises) const {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::int64_t apart =
          rises[i].side[1] * sides_[i].ratio[1] - rises[i].side[0] * sides_[i].ratio[0];
      out = std::max(out, magnitudeOf(apart) >> (lifting::kChangeBits - 1));
    }
    return out;
  }

  /// The prey's mean at the fused place, less prey 0. `difference`: prey i less prey 0.
  [[nodiscard]] std::int64_t mean(const std::array<std::int64_t, kMaxPrey>& difference) const {
    if (birth_.k == 2) return along_ * difference[1] >> 8;
    if (birth_.placement() == Placement::kAtPrey) return difference[birth_.near()];
    std::int64_t sum = 0;
    for (std::size_t i = 1; i < birth_.k; ++i) sum += difference[i];
    return (birth_.k == 3 ? 85 : 64) * sum >> 8;
  }
  /// Whether all corners of its slopes have a value.
  template <class Has>
  [[nodiscard]] bool isWhole(const Has& has) const {
    return std::ranges::all_of(slopes_, [&](const Slope& slope) {
      for (std::size_t i = 0; i < slope.vertex.size(); ++i)
        if (slope.weight[i] != 0 && !has(slope.vertex[i])) return false;
      return true;
    });
  }
  /// The weight of the curvature, which counts where the record is whole.
  [[nodiscard]] std::int64_t curveWeight(const LiftingRule& rule) const {
    if (birth_.k != 2 || !sides_[0].showsCurve()) return 0;
    return std::int64_t{rule.curve} * 4 * along_ * (256 - along_) >> 16;
  }
  /// The value at the fused place as the two exits have it. REQUIRES: a curvature counts.
  template <class At>
  [[nodiscard]] std::int64_t link(const At& at) const {
    const Slope& slope = slopes_[0];
    std::size_t i = 0;
    while (slope.weight[i] == 0) ++i;
    const std::int64_t from = at(slope.vertex[i]);  // since rounded weights do not sum up to 0
    Rise rise;
    for (; i < slope.vertex.size(); ++i)
      rise.side[i / 3] += slope.weight[i] * (at(slope.vertex[i]) - from);
    return from +
           lifting::rounded(sides_[0].reach[0] * rise.side[1] - sides_[0].reach[1] * rise.side[0],
                            lifting::kChangeBits);
  }
  [[nodiscard]] int along() const { return along_; }
  /// The fused value that follows from the prey's; the curvature counts where the record is whole.
  template <class At>
  [[nodiscard]] std::int64_t follows(const LiftingRule& rule,
                                     const std::array<std::int64_t, kMaxPrey>& prey, const At& at,
                                     bool isWhole) const {
    std::array<std::int64_t, kMaxPrey> difference{};
    for (std::size_t i = 1; i < birth_.k; ++i) difference[i] = prey[i] - prey[0];
    const std::int64_t weight = isWhole ? curveWeight(rule) : 0;
    return lifting::lifted(prey[0] + mean(difference), weight == 0 ? 0 : link(at), weight);
  }

 private:
  // A steep field over a long step predicts far beyond any value.
  static constexpr std::int64_t kFurthest = kMaxDracoMagnitude / 2;
  // The shares, in 1/64, of both sides alike, of the side beyond the far prey vertex, and of the
  // one beyond the near one. They depend on where the fused vertex lies.
  struct Shares {
    std::int64_t both, far, near;
  };
  static constexpr Shares kAtPrey{19, 45, 0}, kAtQuarter{30, 26, 8}, kAtMiddle{20, 22, 22};

  [[nodiscard]] std::int64_t blended(const SlopeSides& sides, const Rise& rise) const {
    const int off = std::min(along_, 256 - along_);
    const Shares& shares = birth_.k > 2 || off < 32 ? kAtPrey : off < 96 ? kAtQuarter : kAtMiddle;
    const std::size_t far = birth_.k > 2 || along_ <= 128;
    return lifting::rounded(shares.both * (rise.side[0] + rise.side[1]) +
                                shares.far * (rise.side[far] * sides.ratio[far] >> 8) +
                                shares.near * (rise.side[1 - far] * sides.ratio[1 - far] >> 8),
                            Slope::kWeightBits + 6);
  }
  [[nodiscard]] static std::int64_t within(const Slope& slope, const SlopeSides& sides,
                                           const Rise& rise) {
    std::int64_t sum = 0;
    int n = 0;
    for (std::size_t side = 0; side < 2; ++side)
      if (!slope.isBeyond(side) && sides.reach[side] > 0)
        sum += rise.side[side] * sides.ratio[side], ++n;
    return n == 0 ? 0 : lifting::rounded(sum / n, lifting::kChangeBits);
  }
  // From changes along the steps to differences to prey 0.
  void spread(const std::array<std::int64_t, kMaxPrey>& step,
              std::array<std::int64_t, kMaxPrey>& difference) const {
    for (std::size_t i = 1; i < birth_.k; ++i)
      difference[i] =
          std::clamp(birth_.k == 2 ? step[0] : step[i] - step[0], -kFurthest, kFurthest);
  }

  const Birth& birth_;
  std::span<const Slope> slopes_;
  std::array<SlopeSides, kMaxPrey> sides_{};
  std::size_t count_ = 0;
  bool isBeyond_ = false, hasBoth_ = true;
  int along_ = 0;  // where the fused vertex lies, from prey 0 to prey 1, in 1/256
};

}  // namespace qtet
