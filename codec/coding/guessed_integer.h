// Integers whose sizes are guessed from what lies round them (VALUES.md, "Guessed integers"). Both
// directions; integers only, so that every machine guesses alike.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "codec/coding/log2_fixed.h"
#include "codec/coding/mixed_bit.h"
#include "codec/coding/range_coder.h"

namespace qtet {

/// How large an integer may be, as far as that is known before it is coded. Sizes are log2, in
/// sixteenths. A step is half an octave.
struct SizeHints {
  static constexpr int kMaxAround = 4 * 59;  ///< sixteenths
  static constexpr int kMaxSteps = 31;

  int around = 0;          ///< mean size of what was coded at the vertices round it, 0..kMaxAround
  int bend = 0;            ///< steps: how far two sides disagree; kMaxSteps: not known
  int slope = 0;           ///< steps: how much changes along the way
  int spread = 0;          ///< steps: the largest difference round it
  int beside = 0;          ///< bits of the largest integer of its record so far
  int shift = 0;           ///< bits that its unit stands for, 0..kMaxShift
  std::uint8_t kind = 0;   ///< 0..kKinds - 1, of its record
  std::uint8_t place = 0;  ///< 0..kPlaces - 1, of the fused vertex
  std::uint8_t sign = 0;   ///< which sign is likely: 0 none, 1 plus, 2 minus
  bool isFirst = true;     ///< of its record's in this component

  static constexpr std::size_t kKinds = 4, kPlaces = 4;
  static constexpr int kMaxShift = 30;
};

/// The steps of a magnitude: 0 for 0, 1 for 1, 3 for 2, at most kMaxSteps.
[[nodiscard]] inline int stepsOf(std::uint64_t magnitude) {
  return magnitude == 0 ? 0 : std::min(log2Fixed(magnitude) / 32 + 1, SizeHints::kMaxSteps);
}
[[nodiscard]] inline std::uint64_t magnitudeOf(std::int64_t x) {
  return x < 0 ? 0 - static_cast<std::uint64_t>(x) : static_cast<std::uint64_t>(x);
}
/// log2(1 + |x|) in quarters: what a vertex remembers. At most 124 for 31 bits.
[[nodiscard]] inline std::uint8_t sizeOf(std::int64_t x) {
  return static_cast<std::uint8_t>(log2Fixed(1 + magnitudeOf(x)) / 16);
}

/// Guesses a size, in sixteenths, as a weighted sum of seven figures. The weights learn.
class SizeGuess {
 public:
  using Figures = std::array<std::int32_t, 7>;

  [[nodiscard]] std::int32_t of(const Figures& figures) {
    figures_ = figures;
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < figures.size(); ++i) sum += std::int64_t{weights_[i]} * figures[i];
    return guess_ = static_cast<std::int32_t>(std::clamp<std::int64_t>(sum >> 16, 0, kMax));
  }
  /// REQUIRES: of() was asked before.
  void learn(std::int32_t truth) {
    assert(0 <= guess_ && guess_ <= kMax);
    std::int64_t square = 256;
    for (const std::int32_t x : figures_) square += std::int64_t{x} * x;
    // beyond the largest guess nothing is learned, so that no weight grows for ever
    const std::int64_t error = std::int64_t{kRate} * (std::min(truth, kMax) - guess_);
    const std::int64_t step = error * 65536 / square;
    for (std::size_t i = 0; i < figures_.size(); ++i)
      weights_[i] += static_cast<std::int32_t>(step * figures_[i] >> 16);
  }

  static constexpr std::int32_t kMax = 16 * 17;

 private:
  static constexpr std::int32_t kQuarter = 65536 / 4;
  static constexpr std::int32_t kRate = 300;

  Figures weights_{kQuarter, kQuarter, kQuarter, 0, 0, kQuarter, 0};  // in 1/65536
  Figures figures_{};
  std::int32_t guess_ = 0;
};

/// The models of one kind of integers: a component's differences, or its corrections. They take
/// 140 kB.
class GuessedIntegers {
 public:
  /// An integer, or what a decoder reads. False: a length that does not exist.
  template <class Coder>
  [[nodiscard]] bool code(Coder& coder, const SizeHints& hints, std::int32_t& value) {
    assert(0 <= hints.around && hints.around <= SizeHints::kMaxAround && hints.kind < 4);
    const auto less = [&](int size) { return std::max(0, size - 16 * hints.shift); };
    SizeGuess& guess = guess_[hints.kind];
    const int bend = hints.bend == SizeHints::kMaxSteps ? 0 : 8 * hints.bend;
    const std::int32_t expected =
        guess.of({running_ / 16, less(hints.around), less(bend), less(8 * hints.slope),
                  less(8 * hints.spread), less(16 * hints.beside), 64});
    const auto coarse = std::min(static_cast<std::size_t>(expected / 12), kCoarse - 1);
    Row& round = round_[static_cast<std::size_t>(hints.around / 12)][coarse];
    Row& beside = beside_[static_cast<std::size_t>(std::min(hints.beside, 15) * 4 +
                                                   std::min(hints.shift, 3))];
    Row& bent = bent_[static_cast<std::size_t>(hints.bend)][coarse];
    Row& placed = placed_[hints.place][static_cast<std::size_t>(expected / 2)];
    auto& mixers = mixers_[static_cast<std::size_t>(hints.kind * 2 + (hints.isFirst ? 0 : 1))];
    const auto truth = static_cast<std::uint32_t>(magnitudeOf(value));
    const int wanted = std::bit_width(truth);
    int length = 0;
    for (; length <= kMaxBits; ++length) {
      const std::size_t j = std::min(static_cast<std::size_t>(length), kLengths - 1);
      const std::array<BitModel*, 4> models{&round[j], &beside[j], &bent[j], &placed[j]};
      if (!mixedBit(coder, wanted > length, models, mixers[j])) break;
    }
    if (length > kMaxBits) return false;
    running_ += (256 * length - running_) / 16;
    if (length == 0)
      value = 0;
    else
      codeBits(coder, hints, length, truth, value);
    guess.learn(log2Fixed(1 + magnitudeOf(value)) / 4);
    return true;
  }

 private:
  static constexpr std::size_t kLengths = 18, kCoarse = 24;
  static constexpr int kMaxBits = 31;
  using Row = std::array<BitModel, kLengths>;

  template <class Coder>
  void codeBits(Coder& coder, const SizeHints& hints, int length, std::uint32_t truth,
                std::int32_t& value) {
    const std::size_t j = std::min(static_cast<std::size_t>(length), kLengths - 1);
    std::uint32_t out = 1;
    const int modelled = std::min(length - 1, 2);
    for (int bit = 0; bit < modelled; ++bit)
      out = out * 2 + static_cast<std::uint32_t>(coder.bit(
                          static_cast<int>(truth >> (length - 2 - bit) & 1), top_[j][out]));
    const int rest = length - 1 - modelled;
    if (rest > 0) out = out << rest | coder.raw(truth & ((1u << rest) - 1), rest);
    const bool negative = coder.bit(value < 0, sign_[hints.sign][j]) != 0;
    value = negative ? -static_cast<std::int32_t>(out) : static_cast<std::int32_t>(out);
  }

  std::array<SizeGuess, SizeHints::kKinds> guess_;
  int running_ = 0;  // mean length in bits, in 1/256
  std::array<std::array<Row, kCoarse>, SizeHints::kMaxAround / 12 + 1> round_;
  std::array<Row, 64> beside_;
  std::array<std::array<Row, kCoarse>, SizeHints::kMaxSteps + 1> bent_;
  std::array<std::array<Row, SizeGuess::kMax / 2 + 1>, SizeHints::kPlaces> placed_;
  std::array<std::array<Mixer<4>, kLengths>, 2 * SizeHints::kKinds> mixers_;
  std::array<std::array<BitModel, 4>, kLengths> top_;
  std::array<std::array<BitModel, kLengths>, 3> sign_;
};

}  // namespace qtet
