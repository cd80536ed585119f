#include "codec/coding/adaptive_block.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "codec/coding/mixed_bit.h"
#include "codec/coding/range_coder.h"
#include "proto/limits.h"

namespace qtet {
namespace {

// Components beyond the fourth share the fourth's models, lengths beyond the 16th bit those of the
// 16th.
constexpr std::size_t kAxes = 4;
constexpr std::size_t kLengths = 17;
constexpr int kMaxBits = 31;

/// Codes a value as the number of its magnitude's bits and the bits below the leading one. The
/// number's model depends on the lengths of the tuple before and of the component before.
template <class Coder>
class AdaptiveCoder {
 public:
  AdaptiveCoder(Coder& coder, std::uint32_t components) : coder_(coder), before_(components, 0) {}

  /// False for a length that does not exist.
  [[nodiscard]] bool code(std::span<std::int32_t> tuple) {
    std::size_t beside = 0;
    for (std::size_t c = 0; c < tuple.size(); ++c) {
      const std::size_t axis = std::min(c, kAxes - 1);
      const int length = lengthOf(axis, beside, before_[c], tuple[c]);
      if (length > kMaxBits) return false;
      tuple[c] = value(axis, length, tuple[c]);
      beside = before_[c] = std::min(static_cast<std::size_t>(length), kLengths - 1);
      running_[axis] += (length * 16 - running_[axis]) / 8;
    }
    return true;
  }

 private:
  int lengthOf(std::size_t axis, std::size_t beside, std::size_t before, std::int32_t truth) {
    const int wanted = std::bit_width(magnitude(truth));
    const auto usual = std::min(static_cast<std::size_t>(running_[axis] / 8), 2 * kLengths - 1);
    int length = 0;
    for (; length <= kMaxBits; ++length) {
      const std::size_t i = std::min(static_cast<std::size_t>(length), kLengths - 1);
      const std::array<BitModel*, 3> models{&beforeModel_[axis][before][i],
                                            &besideModel_[axis][beside][i],
                                            &usualModel_[axis][usual][i]};
      if (!mixedBit(coder_, wanted > length, models, mixer_[axis][i])) break;
    }
    return length;
  }

  std::int32_t value(std::size_t axis, int length, std::int32_t truth) {
    if (length == 0) return 0;
    const std::uint32_t u = magnitude(truth);
    std::uint32_t out = 1;
    const std::size_t i = std::min(static_cast<std::size_t>(length), kLengths - 1);
    const int modelled = std::min(length - 1, 2);
    for (int bit = 0; bit < modelled; ++bit)
      out = out * 2 + static_cast<std::uint32_t>(coder_.bit(
                          static_cast<int>(u >> (length - 2 - bit) & 1), top_[axis][i][out]));
    const int rest = length - 1 - modelled;
    if (rest > 0) out = out << rest | coder_.raw(u & ((1u << rest) - 1), rest);
    const bool negative = coder_.bit(truth < 0, sign_[axis][i]) != 0;
    return negative ? -static_cast<std::int32_t>(out) : static_cast<std::int32_t>(out);
  }

  static std::uint32_t magnitude(std::int32_t x) {
    return x < 0 ? 0u - static_cast<std::uint32_t>(x) : static_cast<std::uint32_t>(x);
  }

  template <std::size_t N>
  using Lengths = std::array<std::array<std::array<BitModel, kLengths>, N>, kAxes>;

  Coder& coder_;
  std::vector<std::size_t> before_;   // lengths of the tuple before
  std::array<int, kAxes> running_{};  // mean length, in sixteenths
  Lengths<kLengths> beforeModel_, besideModel_;
  Lengths<2 * kLengths> usualModel_;
  std::array<std::array<Mixer<3>, kLengths>, kAxes> mixer_;
  std::array<std::array<std::array<BitModel, 4>, kLengths>, kAxes> top_;
  std::array<std::array<BitModel, kLengths>, kAxes> sign_;
};

}  // namespace

Bytes encodeAdaptiveBlock(std::span<const std::int32_t> values, std::uint32_t components) {
  assert(components > 0 && components <= kMaxFieldComponents && values.size() % components == 0);
  if (values.empty()) return {};
  RangeEncoder encoder;
  AdaptiveCoder<RangeEncoder> coder(encoder, components);
  std::vector<std::int32_t> tuple(components);
  for (std::size_t i = 0; i < values.size(); i += components) {
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i), components, tuple.begin());
    (void)coder.code(tuple);
  }
  return encoder.finish();
}

Result<std::vector<std::int32_t>> decodeAdaptiveBlock(ByteView bytes, std::uint32_t components,
                                                      std::uint32_t tuples) {
  if (tuples == 0)
    return bytes.empty() ? Result<std::vector<std::int32_t>>{}
                         : fail(ErrorCode::kBadValue, "a value block of no values has bytes");
  if (std::uint64_t{tuples} * components > kMaxDecisionsPerByte * (std::uint64_t{bytes.size()} + 4))
    return fail(ErrorCode::kLimitExceeded, "a value block promises more than its bytes can hold");
  std::vector<std::int32_t> values(std::size_t{tuples} * components);
  RangeDecoder decoder(bytes);
  AdaptiveCoder<RangeDecoder> coder(decoder, components);
  for (std::size_t i = 0; i < values.size(); i += components) {
    if (!coder.code(std::span(values).subspan(i, components)))
      return fail(ErrorCode::kBadValue, "a value block holds a value of more than 31 bits");
    if (decoder.overrun())
      return fail(ErrorCode::kTruncated, "a value block ends before its values do");
  }
  if (!decoder.atEnd())
    return fail(ErrorCode::kBadValue, "a value block is longer than its values");
  return values;
}

}  // namespace qtet
