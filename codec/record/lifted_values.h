// Point fields with every value coded once (VALUES.md, "Lifted blocks"). A record codes how
// its prey vertices differ, and how far the fused value is off the one that follows from them.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/coding/guessed_integer.h"
#include "codec/coding/range_coder.h"
#include "codec/mesh/mesh.h"
#include "codec/record/base_coder.h"
#include "codec/record/lifted_record.h"
#include "codec/record/point_values.h"
#include "proto/bytes.h"
#include "proto/limits.h"

namespace qtet {

/// A point field as it stands while its blocks come: by slot, components a vertex.
struct LiftedField {
  std::span<std::int32_t> values;
  std::span<std::uint8_t> sizes;  ///< of what was coded there, in quarters of a bit
};

/// Components beyond the fourth share the fourth's models.
inline constexpr std::size_t kLiftedAxes = 4;
/// Bytes of a LiftedBlock's models.
[[nodiscard]] constexpr std::size_t liftedModelBytes(std::uint32_t components) {
  return 2 * std::min<std::size_t>(components, kLiftedAxes) * sizeof(GuessedIntegers);
}

/// The most values that a block of these bytes can hold.
[[nodiscard]] constexpr std::uint64_t mostValuesIn(ByteView block) {
  return kMaxDecisionsPerByte * (std::uint64_t{block.size()} + 4);
}

/// One field's block of a chunk, in both directions. `Coder` is a RangeEncoder or a RangeDecoder.
template <class Coder>
class LiftedBlock {
 public:
  /// All must outlive it. REQUIRES: 1 to kMaxFieldComponents components.
  LiftedBlock(Coder& coder, const LiftedField& field, std::uint32_t components, bool hasMissing)
      : coder_(coder),
        field_(field),
        components_(components),
        hasMissing_(hasMissing),
        models_(2 * std::min<std::size_t>(components, kAxes)) {
    assert(components > 0 && components <= kMaxFieldComponents);
    assert(field.values.size() == field.sizes.size() && field.values.size() % components == 0);
  }

  /// A value is out of range, or was too large to be coded.
  [[nodiscard]] bool bad() const { return bad_; }

  /// Vertex v of the base mesh. An encoder's value is there already. REQUIRES: in order of slots.
  void base(VertexId v, const BaseBirth& birth);
  /// The rule of the level whose records follow.
  [[nodiscard]] LiftingRule rule(const LiftingRule& truth);
  /// A record, whose fused value is in its slot. `truth`: the prey's values, components each, in
  /// order; a decoder needs none. REQUIRES, where it encodes: the fused value is off the one that
  /// follows from the prey by a multiple of 2^shift, by nothing without corrections. It is missing
  /// where those of all prey are, and only there.
  void record(const LiftingRule& rule, const Birth& birth, std::span<const Slope> slopes,
              std::span<const std::int32_t> truth);

 private:
  static constexpr std::size_t kAxes = kLiftedAxes;
  static constexpr std::int64_t kLargest = std::int64_t{1} << 30;
  using Prey = std::array<std::int64_t, LiftedRecord::kMaxPrey>;

  [[nodiscard]] std::int32_t& at(VertexId v, std::uint32_t c) const {
    return field_.values[std::size_t{v} * components_ + c];
  }
  [[nodiscard]] std::uint8_t& size(VertexId v, std::uint32_t c) const {
    return field_.sizes[std::size_t{v} * components_ + c];
  }
  [[nodiscard]] GuessedIntegers& models(std::uint32_t c, bool isCorrection) {
    return models_[2 * std::min<std::size_t>(c, kAxes - 1) + (isCorrection ? 1 : 0)];
  }
  std::int64_t integer(std::uint32_t c, bool isCorrection, const SizeHints& hints,
                       std::int64_t truth);
  bool isMissing(std::size_t context, bool truth);
  void component(const LiftingRule& rule, const LiftedRecord& record, std::uint32_t c,
                 const Prey& truth);
  void rim(const LiftingRule& rule, const LiftedRecord& record, std::uint32_t c, unsigned present,
           const Prey& truth);
  [[nodiscard]] unsigned presentPrey(const LiftedRecord& record, std::uint32_t c,
                                     const Prey& truth);
  /// A record's corners in one component.
  struct Corners {
    LiftedRecord::Rises rises;  ///< to the fused value, which a missing one counts as
    SizeHints hints;            ///< what they tell of it
    bool isWhole = true;        ///< none is missing
  };
  [[nodiscard]] Corners cornersOf(const LiftedRecord& record, std::uint32_t c) const;
  [[nodiscard]] LiftedRecord::Guess guessOf(const LiftedRecord& record, std::uint32_t c,
                                            const LiftedRecord::Rises& rises,
                                            LiftedRecord::Guess& other) const;
  std::int32_t checked(std::int64_t value) {
    if (-kLargest <= value && value <= kLargest) return static_cast<std::int32_t>(value);
    bad_ = true;
    return 0;
  }

  Coder& coder_;
  const LiftedField field_;
  const std::uint32_t components_;
  const bool hasMissing_;
  std::vector<GuessedIntegers> models_;  // by axis: of differences, of corrections
  std::array<BitModel, 6> missing_;
  BitModel sameShift_, sameCurve_;
  LiftingRule before_;
  std::array<int, kAxes> boundaryScore_{};  // above 0: exits on the boundary predict worse
  int longest_ = 0;                         // bits of the record's largest difference so far
  bool bad_ = false;
};

template <class Coder>
std::int64_t LiftedBlock<Coder>::integer(std::uint32_t c, bool isCorrection, const SizeHints& hints,
                                         std::int64_t truth) {
  constexpr std::int64_t kMost = (std::int64_t{1} << 31) - 1;
  std::int32_t value = 0;
  if constexpr (Coder::kEncoding) {
    bad_ |= truth < -kMost || truth > kMost;
    value = static_cast<std::int32_t>(std::clamp(truth, -kMost, kMost));
  }
  bad_ |= !models(c, isCorrection).code(coder_, hints, value);
  return value;
}

template <class Coder>
bool LiftedBlock<Coder>::isMissing(std::size_t context, bool truth) {
  return coder_.bit(truth ? 1 : 0, missing_[context]) != 0;
}

template <class Coder>
void LiftedBlock<Coder>::base(VertexId v, const BaseBirth& birth) {
  for (std::uint32_t c = 0; c < components_; ++c) {
    const auto value = [&](VertexId u, std::uint32_t i) { return at(u, i); };
    if (hasMissing_) {
      bool isNear = false;
      if (birth.from[0] != kGhost)
        for (std::size_t i = 0; i < 3; ++i) isNear = isNear || at(birth.from[i], c) == kMissing;
      if (isMissing(isNear ? 1 : 0, at(v, c) == kMissing)) {
        at(v, c) = kMissing;
        continue;
      }
    }
    const std::int64_t predicted = predictBaseField(birth, v, c, hasMissing_, value);
    SizeHints hints;
    hints.kind = 3;
    hints.isFirst = c == 0;
    const std::int64_t coded = integer(c, false, hints, at(v, c) - predicted);
    at(v, c) = checked(predicted + coded);
    size(v, c) = sizeOf(coded);
  }
}

template <class Coder>
LiftingRule LiftedBlock<Coder>::rule(const LiftingRule& truth) {
  LiftingRule out = before_;
  if (coder_.bit(truth.shift == before_.shift ? 1 : 0, sameShift_) == 0)
    out.shift = static_cast<int>(coder_.raw(static_cast<std::uint32_t>(truth.shift + 1), 5)) - 1;
  if (coder_.bit(truth.curve == before_.curve ? 1 : 0, sameCurve_) == 0)
    out.curve = static_cast<int>(coder_.raw(static_cast<std::uint32_t>(truth.curve), 7));
  return before_ = out;
}

template <class Coder>
void LiftedBlock<Coder>::record(const LiftingRule& rule, const Birth& birth,
                                std::span<const Slope> slopes,
                                std::span<const std::int32_t> truth) {
  const LiftedRecord record(birth, slopes);
  longest_ = 0;
  for (std::uint32_t c = 0; c < components_; ++c) {
    Prey prey{};
    if constexpr (Coder::kEncoding) {
      assert(truth.size() == std::size_t{birth.k} * components_);
      for (std::size_t i = 0; i < birth.k; ++i) prey[i] = truth[i * components_ + c];
    }
    const unsigned all = (1u << birth.k) - 1;
    const unsigned present = hasMissing_ ? presentPrey(record, c, prey) : all;
    if (present == all)
      component(rule, record, c, prey);
    else
      rim(rule, record, c, present, prey);
  }
}

/// Which prey have a value, as bits.
template <class Coder>
unsigned LiftedBlock<Coder>::presentPrey(const LiftedRecord& record, std::uint32_t c,
                                         const Prey& truth) {
  const Birth& birth = record.birth();
  if (at(birth.slot, c) == kMissing) {
    if constexpr (Coder::kEncoding)
      bad_ |= !std::ranges::all_of(std::span(truth).first(birth.k),
                                   [](std::int64_t x) { return x == kMissing; });
    return 0;
  }
  std::size_t context = 2;
  for (const Slope& slope : record.slopes())
    for (std::size_t i = 0; i < slope.vertex.size(); ++i)
      if (slope.weight[i] != 0 && at(slope.vertex[i], c) == kMissing) context = 4;
  unsigned present = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < birth.k; ++i) {
    // one prey vertex has a value where the fused one has
    const bool isSure = i + 1u == birth.k && present == 0;
    if (!isSure && isMissing(context + (count < i ? 1 : 0), truth[i] == kMissing)) continue;
    present |= 1u << i;
    ++count;
  }
  return present;
}

/// A record of which some prey have no value: the others by their difference to the fused one.
template <class Coder>
void LiftedBlock<Coder>::rim(const LiftingRule& rule, const LiftedRecord& record, std::uint32_t c,
                             unsigned present, const Prey& truth) {
  const Birth& birth = record.birth();
  const std::int64_t fused = at(birth.slot, c);
  const int was = size(birth.slot, c);
  SizeHints hints;
  hints.kind = 2;
  hints.around = std::min(4 * was, SizeHints::kMaxAround);
  bool isFirst = true;
  for (std::size_t i = 0; i < birth.k; ++i) {
    const VertexId slot = birth.preySlot(i);
    size(slot, c) = static_cast<std::uint8_t>(was);
    if ((present >> i & 1) == 0) {
      at(slot, c) = kMissing;
      continue;
    }
    // without corrections the first one's value is the fused one
    const bool isCoded = rule.isCorrected() || !isFirst;
    hints.isFirst = isFirst;
    const std::int64_t coded = isCoded ? integer(c, false, hints, truth[i] - fused) : 0;
    at(slot, c) = checked(fused + coded);
    size(slot, c) = static_cast<std::uint8_t>((was + sizeOf(coded) + 1) / 2);
    isFirst = false;
  }
}

template <class Coder>
auto LiftedBlock<Coder>::cornersOf(const LiftedRecord& record, std::uint32_t c) const -> Corners {
  const Birth& birth = record.birth();
  const std::int64_t fused = at(birth.slot, c);
  unsigned sum = 2u * size(birth.slot, c), count = 2;
  std::uint64_t spread = 0;
  Corners out;
  Rise* rise = out.rises.data();
  for (const Slope& slope : record.slopes()) {
    for (std::size_t i = 0; i < slope.vertex.size(); ++i) {
      if (slope.weight[i] == 0) continue;
      const std::size_t corner = std::size_t{slope.vertex[i]} * components_ + c;
      sum += field_.sizes[corner], ++count;
      if (hasMissing_ && field_.values[corner] == kMissing) {
        out.isWhole = false;
        continue;
      }
      const std::int64_t apart = field_.values[corner] - fused;
      rise->side[i / 3] += slope.weight[i] * apart;
      spread = std::max(spread, magnitudeOf(apart));
    }
    ++rise;
  }
  out.hints.around = std::min(static_cast<int>(4 * (sum / count)), SizeHints::kMaxAround);
  out.hints.spread = stepsOf(spread);
  out.hints.place = static_cast<std::uint8_t>(birth.placement());
  return out;
}

/// The guess that counts. REQUIRES of `other`: where exits lie on the boundary, it becomes the one
/// that does not.
template <class Coder>
LiftedRecord::Guess LiftedBlock<Coder>::guessOf(const LiftedRecord& record, std::uint32_t c,
                                                const LiftedRecord::Rises& rises,
                                                LiftedRecord::Guess& other) const {
  LiftedRecord::Guess guess = record.guess(rises);
  if (!record.isBeyond()) return guess;
  other = record.guessWithin(rises);
  if (boundaryScore_[std::min<std::size_t>(c, kAxes - 1)] > 0) std::swap(guess, other);
  return guess;
}

template <class Coder>
void LiftedBlock<Coder>::component(const LiftingRule& rule, const LiftedRecord& record,
                                   std::uint32_t c, const Prey& truth) {
  const Birth& birth = record.birth();
  const std::int64_t fused = at(birth.slot, c);
  const Corners corners = cornersOf(record, c);
  LiftedRecord::Guess other;
  const LiftedRecord::Guess guess = guessOf(record, c, corners.rises, other);
  SizeHints hints = corners.hints;
  hints.kind = birth.k > 2 ? 2 : guess.hasBoth ? 0 : 1;
  hints.bend = guess.hasBoth
                   ? std::min(stepsOf(record.bend(corners.rises)), SizeHints::kMaxSteps - 1)
                   : SizeHints::kMaxSteps;
  std::uint64_t steepest = 0;
  for (std::size_t i = 1; i < birth.k; ++i)
    steepest = std::max(steepest, magnitudeOf(guess.plain[i]));
  hints.slope = stepsOf(2 * steepest);
  const int was = size(birth.slot, c);

  Prey difference{};
  int largest = 0, better = 0;
  std::int64_t coded = 0;
  for (std::size_t i = 1; i < birth.k; ++i) {
    const std::int64_t apart = guess.plain[i] - guess.difference[i];
    hints.sign = apart > 0 ? 1 : apart < 0 ? 2 : 0;
    hints.isFirst = i == 1;
    hints.beside = longest_;
    coded = integer(c, false, hints, truth[i] - truth[0] - guess.difference[i]);
    difference[i] = guess.difference[i] + coded;
    largest = std::max(largest, int{sizeOf(coded)});
    longest_ = std::max(longest_, static_cast<int>(std::bit_width(magnitudeOf(coded))));
    if (record.isBeyond()) better += sizeOf(difference[i] - other.difference[i]) - sizeOf(coded);
  }
  if (record.isBeyond()) {
    int& score = boundaryScore_[std::min<std::size_t>(c, kAxes - 1)];
    score += (score > 0 ? better : -better) - score / 16;
  }

  const std::int64_t mean = record.mean(difference);
  const std::int64_t weight = corners.isWhole ? record.curveWeight(rule) : 0;
  const std::int64_t link =
      weight == 0 ? 0 : record.link([&](VertexId v) -> std::int64_t { return at(v, c); });
  std::int64_t base = fused;
  if (rule.isCorrected()) {
    hints.sign = coded > 0 ? 1 : coded < 0 ? 2 : 0;
    hints.isFirst = true;
    hints.beside = longest_;
    hints.shift = rule.shift;
    hints.bend = std::clamp(largest - 4 * rule.shift + 16, 0, SizeHints::kMaxSteps - 1);
    const std::int64_t follows = lifting::lifted(truth[0] + mean, link, weight);
    const std::int64_t correction = integer(c, true, hints, (fused - follows) >> rule.shift);
    base -= correction * (std::int64_t{1} << rule.shift);
  }
  // far beyond any value, and still far from 64 bits
  constexpr std::int64_t kFurthestBase = std::int64_t{1} << 33;
  if (base < -kFurthestBase || base > kFurthestBase) bad_ = true, base = fused;
  const std::int64_t first = lifting::meanOf(base, link, weight) - mean;
  // an encoder's fused value is off by a multiple of the rule's unit
  if constexpr (Coder::kEncoding) bad_ |= first != truth[0];
  for (std::size_t i = 0; i < birth.k; ++i) {
    const VertexId slot = birth.preySlot(i);
    at(slot, c) = checked(first + difference[i]);
    size(slot, c) = static_cast<std::uint8_t>((was + largest + 1) / 2);
  }
}

}  // namespace qtet
