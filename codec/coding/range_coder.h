// An adaptive binary range coder with integer probabilities (FORMAT.md, "Range coder"). Encoder,
// decoder and a coder that only answers have the same face, so one template describes a stream in
// both directions.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>

#include "codec/coding/log2_fixed.h"
#include "proto/bytes.h"

namespace qtet {

/// Probability that the next decision is 1, in 1/65536, and how often it was asked: young models
/// learn fast. In one word, the probability above, since a decoder spends a third of its time on
/// them.
struct BitModel {
  std::uint32_t state = std::uint32_t{32768} << 16;

  [[nodiscard]] std::uint32_t probability() const { return state >> 16; }
};

namespace range {

// A decision costs at least log2(65536 / 65504) = 1/1420 bit: kMaxDecisionsPerByte rests on it.
inline constexpr std::uint32_t kLowest = 32;
inline constexpr std::uint32_t kHighest = 65536 - kLowest;
// a model's memory in decisions; 60 to 160 measured within 0.3 %
inline constexpr std::uint32_t kSlowest = 90;

/// By count: how fast the model learns, and whether the count grows.
struct Rate {
  std::uint16_t rate = 0, more = 0;
};
inline constexpr auto kRates = [] {
  std::array<Rate, kSlowest + 1> rates{};
  for (std::uint32_t n = 0; n <= kSlowest; ++n)
    rates[n] = {static_cast<std::uint16_t>(655360u / (10 * n + 16)), n < kSlowest};
  return rates;
}();

inline std::uint32_t clamped(const BitModel& model) {
  const std::uint32_t p = model.probability();
  return p < kLowest ? kLowest : p > kHighest ? kHighest : p;
}

inline void update(BitModel& model, int bit) {
  const std::uint32_t s = model.state;
  const auto [rate, more] = kRates[s & 0xFFFF];
  // of a product of 16 bits by 16, what >> 16 leaves, in its place
  constexpr std::uint32_t kProbability = 0xFFFF0000u;
  model.state =
      (bit ? s + ((~s >> 16) * rate & kProbability) : s - ((s >> 16) * rate & kProbability)) + more;
}

}  // namespace range

class RangeEncoder {
 public:
  static constexpr bool kEncoding = true;

  int bit(int value, BitModel& model) {
    assert(value == 0 || value == 1);
    encode(value, range::clamped(model));
    range::update(model, value);
    return value;
  }
  /// A decision whose probability of being 1 is known, in 1/65536. REQUIRES kLowest <= probability
  /// <= kHighest.
  int likely(int value, std::uint32_t probability) {
    assert(range::kLowest <= probability && probability <= range::kHighest);
    encode(value, probability);
    return value;
  }
  /// `bits` equiprobable bits, 0..32: as they are, from the end of the stream backwards.
  std::uint32_t raw(std::uint32_t value, int bits) {
    assert(0 <= bits && bits <= 32 && std::uint64_t{value} >> bits == 0);
    pending_ |= std::uint64_t{value} << pendingBits_;
    for (pendingBits_ += bits; pendingBits_ >= 8; pendingBits_ -= 8, pending_ >>= 8)
      raw_.push_back(static_cast<std::uint8_t>(pending_));
    cost_ += 64 * static_cast<std::uint64_t>(bits);
    return value;
  }
  /// The approximate cost of everything so far, in 64ths of a bit; for statistics.
  [[nodiscard]] std::uint64_t cost() const { return cost_; }
  [[nodiscard]] std::size_t size() const { return writer_.bytes().size() + raw_.size(); }
  /// Ends the stream and begins the next one.
  [[nodiscard]] Bytes finish() {
    for (int i = 0; i < 4; ++i) writer_.write(static_cast<std::uint8_t>(low_ >> (24 - 8 * i)));
    low_ = 0, high_ = ~0u;
    if (pendingBits_ > 0) raw_.push_back(static_cast<std::uint8_t>(pending_));
    std::ranges::reverse(raw_);
    writer_.append(raw_);
    raw_.clear(), pending_ = 0, pendingBits_ = 0;
    return std::exchange(writer_, ByteWriter{}).take();
  }

 private:
  void encode(int value, std::uint32_t probability) {
    cost_ += static_cast<std::uint64_t>(
        16 * 64 - log2Fixed(std::uint64_t{value ? probability : 65536 - probability}));
    const std::uint32_t middle =
        low_ + static_cast<std::uint32_t>((std::uint64_t{high_ - low_} * probability) >> 16);
    if (value)
      high_ = middle;
    else
      low_ = middle + 1;
    while (((low_ ^ high_) >> 24) == 0) {
      writer_.write(static_cast<std::uint8_t>(high_ >> 24));
      low_ <<= 8, high_ = high_ << 8 | 255;
    }
  }

  std::uint32_t low_ = 0;
  std::uint32_t high_ = ~0u;
  ByteWriter writer_;
  Bytes raw_;  // the last byte first
  std::uint64_t pending_ = 0, cost_ = 0;
  int pendingBits_ = 0;
};

class RangeDecoder {
 public:
  static constexpr bool kEncoding = false;

  explicit RangeDecoder(ByteView bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
  }
  int bit(int /*unknown*/, BitModel& model) {
    const int value = decode(range::clamped(model));
    range::update(model, value);
    return value;
  }
  int likely(int /*unknown*/, std::uint32_t probability) {
    assert(range::kLowest <= probability && probability <= range::kHighest);
    return decode(probability);
  }
  std::uint32_t raw(std::uint32_t /*unknown*/, int bits) {
    assert(0 <= bits && bits <= 32);
    for (; pendingBits_ < bits; pendingBits_ += 8) {
      ++back_;
      if (back_ <= bytes_.size())
        pending_ |= std::uint64_t{bytes_[bytes_.size() - back_]} << pendingBits_;
    }
    const auto value = static_cast<std::uint32_t>(pending_ & ((std::uint64_t{1} << bits) - 1));
    pending_ >>= bits;
    pendingBits_ -= bits;
    return value;
  }
  /// More was asked for than the bytes hold: what was decoded since is noise.
  [[nodiscard]] bool overrun() const { return position_ + back_ > bytes_.size(); }
  /// Every byte was used, none beyond, and what is left of the last raw byte is 0.
  [[nodiscard]] bool atEnd() const { return position_ + back_ == bytes_.size() && pending_ == 0; }

 private:
  int decode(std::uint32_t probability) {
    const std::uint32_t middle =
        low_ + static_cast<std::uint32_t>((std::uint64_t{high_ - low_} * probability) >> 16);
    const int value = code_ <= middle;
    if (value)
      high_ = middle;
    else
      low_ = middle + 1;
    while (((low_ ^ high_) >> 24) == 0) {
      low_ <<= 8, high_ = high_ << 8 | 255;
      code_ = code_ << 8 | next();
    }
    return value;
  }
  std::uint32_t next() {
    const std::uint32_t byte = position_ < bytes_.size() ? bytes_[position_] : 0;
    ++position_;
    return byte;
  }

  ByteView bytes_;
  std::size_t position_ = 0;  // of the next byte from the front
  std::size_t back_ = 0;      // bytes taken from the end
  std::uint64_t pending_ = 0;
  int pendingBits_ = 0;
  std::uint32_t low_ = 0;
  std::uint32_t high_ = ~0u;
  std::uint32_t code_ = 0;
};

/// Answers every question with the truth and writes nothing: for asking what an encoder would say.
class EchoCoder {
 public:
  static constexpr bool kEncoding = true;
  static int bit(int value, BitModel&) { return value; }
  static int likely(int value, std::uint32_t) { return value; }
  static std::uint32_t raw(std::uint32_t value, int) { return value; }
};

/// An unsigned number as the count of its bits (unary, adaptive) and the bits below the first (the
/// topmost two adaptive, the rest raw).
struct NumberModel {
  std::array<BitModel, 33> length;
  std::array<std::array<BitModel, 4>, 33> top;

  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value) {
    const int wanted = std::bit_width(value);
    int bits = 0;
    while (bits < 32 && coder.bit(wanted > bits, length[static_cast<std::size_t>(bits)])) ++bits;
    if (bits < 2) return static_cast<std::uint32_t>(bits);
    std::uint32_t out = 1;
    std::uint32_t context = 1;
    for (int i = bits - 2; i >= 0; --i) {
      const int asked = static_cast<int>(value >> i & 1);
      std::uint32_t digit = 0;
      if (bits - 2 - i < 2) {
        digit = static_cast<std::uint32_t>(
            coder.bit(asked, top[static_cast<std::size_t>(bits)][context]));
        context = context * 2 + digit;
      } else {
        digit = coder.raw(static_cast<std::uint32_t>(asked), 1);
      }
      out = out * 2 + digit;
    }
    return out;
  }
};

}  // namespace qtet
