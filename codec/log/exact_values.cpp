#include "codec/log/exact_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "codec/coding/float_bits.h"
#include "codec/coding/nearest_integer.h"
#include "codec/coding/range_coder.h"
#include "codec/mesh/mesh.h"
#include "proto/limits.h"

namespace qtet {
namespace {

constexpr double kIntegerEnd = 9007199254740992.0;  // 2^53

/// Numbers of a type as signed integers in the same order, with minus zero just below zero:
/// neighbours differ by 1.
class Ordering {
 public:
  enum class Kind : std::uint8_t { kFloat32, kFloat64, kInteger };

  explicit Ordering(const std::string& type)
      : kind_(type == "float32"   ? Kind::kFloat32
              : type == "float64" ? Kind::kFloat64
                                  : Kind::kInteger) {}

  [[nodiscard]] std::int64_t of(double value) const {
    switch (kind_) {
      case Kind::kFloat32: {
        const auto bits = std::bit_cast<std::uint32_t>(narrowed(value));
        const auto magnitude = static_cast<std::int64_t>(bits & 0x7FFFFFFFu);
        return bits >> 31 != 0 ? ~magnitude : magnitude;
      }
      case Kind::kFloat64: {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        const auto magnitude = static_cast<std::int64_t>(bits & ~(std::uint64_t{1} << 63));
        return bits >> 63 != 0 ? ~magnitude : magnitude;
      }
      case Kind::kInteger: break;
    }
    return std::isnan(value) ? 0
                             : static_cast<std::int64_t>(
                                   std::clamp(nearestInteger(value), -kIntegerEnd, kIntegerEnd));
  }
  /// False: no number of the type.
  [[nodiscard]] bool number(std::int64_t order, double& out) const {
    const bool negative = order < 0;
    const auto magnitude = static_cast<std::uint64_t>(negative ? ~order : order);
    switch (kind_) {
      case Kind::kFloat32:
        if (magnitude >> 31 != 0) return false;
        out = widened(std::bit_cast<float>(static_cast<std::uint32_t>(magnitude) |
                                           (negative ? 0x80000000u : 0u)));
        return true;
      case Kind::kFloat64:
        out = std::bit_cast<double>(magnitude | (negative ? std::uint64_t{1} << 63 : 0));
        return true;
      case Kind::kInteger: break;
    }
    out = static_cast<double>(order);
    return std::abs(out) <= kIntegerEnd;
  }

 private:
  Kind kind_;
};

/// A signed number of up to 65 bits: the count of its magnitude's bits and its leading digits
/// adaptive, the rest raw.
struct CorrectionModel {
  std::array<BitModel, 128> length;
  std::array<std::array<BitModel, 8>, 65> top;

  template <class Coder>
  void code(Coder& coder, bool& negative, std::uint64_t& magnitude) {
    const auto wanted = static_cast<std::uint32_t>(std::bit_width(magnitude));
    std::uint32_t node = 1;
    for (int i = 6; i >= 0; --i)
      node = node * 2 +
             static_cast<std::uint32_t>(coder.bit(static_cast<int>(wanted >> i & 1), length[node]));
    // more: damaged, and found by what comes out
    const std::uint32_t bits = std::min(node - 128, 64u);
    if (bits == 0) {
      magnitude = 0;
      return;
    }
    negative = coder.raw(negative ? 1 : 0, 1) != 0;
    std::uint64_t out = 1;
    std::uint32_t context = 1;
    int left = static_cast<int>(bits) - 1;
    for (; left > 0 && context < 4; --left) {
      const int digit =
          coder.bit(static_cast<int>(magnitude >> (left - 1) & 1), top[bits][context]);
      context = context * 2 + static_cast<std::uint32_t>(digit);
      out = out * 2 + static_cast<std::uint64_t>(digit);
    }
    while (left > 0) {
      const int take = std::min(left, 16);
      left -= take;
      out = out << take |
            coder.raw(static_cast<std::uint32_t>(magnitude >> left & 0xFFFF) & ((1u << take) - 1),
                      take);
    }
    magnitude = out;
  }
};

template <class Coder>
class ExactCoder {
 public:
  ExactCoder(Coder& coder, const Approximation& known, int shift)
      : coder_(coder), known_(known), ordering_(known.type), shift_(shift) {}

  /// Codes every number; an encoder's are read, a decoder's written. `overrun` is asked after each.
  /// False: damaged.
  template <class Overrun>
  [[nodiscard]] bool run(std::vector<double>& exact, const Overrun& overrun) {
    for (std::size_t i = 0; i < exact.size(); ++i) {
      if (!one(known_.integers[i], i % known_.components, exact[i])) return false;
      if (overrun()) return false;
    }
    return true;
  }

 private:
  static constexpr std::size_t kComponents = 4, kSizes = 64;

  bool one(std::int32_t integer, std::size_t component, double& exact) {
    const double near = integer == kMissing ? std::numeric_limits<double>::quiet_NaN()
                                            : known_.minimum[component] + known_.step * integer;
    const std::int64_t expected = ordering_.of(near) >> shift_;
    std::int64_t truth = ordering_.of(exact) >> shift_;
    // The number that this integer stood for last: coordinates of planes, values that occur often.
    std::unordered_map<std::int32_t, std::int64_t>& seen = seen_[component];
    const auto last = seen.find(integer);
    if (last != seen.end() && coder_.bit(truth == last->second, again_[component]) != 0) {
      truth = last->second;
    } else {
      // Modulo 2^64: what is far apart comes round.
      const auto difference =
          static_cast<std::uint64_t>(truth) - static_cast<std::uint64_t>(expected);
      bool negative = difference >> 63 != 0;
      std::uint64_t magnitude = negative ? 0 - difference : difference;
      models_[std::min(component, kComponents - 1)][sizeOf(near)].code(coder_, negative, magnitude);
      truth = static_cast<std::int64_t>(static_cast<std::uint64_t>(expected) +
                                        (negative ? 0 - magnitude : magnitude));
      seen[integer] = truth;
    }
    if (shift_ > 0 && (truth > std::numeric_limits<std::int64_t>::max() >> shift_ ||
                       truth < std::numeric_limits<std::int64_t>::min() >> shift_))
      return false;
    // Below the shift a magnitude's digits are 0: of a negative number, which counts down from -1,
    // they are 1.
    return ordering_.number(truth < 0 ? ~(~truth << shift_) : truth << shift_, exact);
  }

  // How many bits a correction may have: numbers far from zero have less digits below the step.
  [[nodiscard]] std::size_t sizeOf(double near) const {
    const auto exponent = [](double x) {
      return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52 & 0x7FF);
    };
    return static_cast<std::size_t>(
        std::clamp(exponent(known_.step) - exponent(near) + 48, 0, static_cast<int>(kSizes) - 1));
  }

  Coder& coder_;
  const Approximation& known_;
  Ordering ordering_;
  int shift_;
  std::array<BitModel, kMaxFieldComponents> again_;
  std::array<std::unordered_map<std::int32_t, std::int64_t>, kMaxFieldComponents> seen_;
  std::vector<std::array<CorrectionModel, kSizes>> models_{kComponents};
};

/// Trailing zeros that the digits of all numbers share: those of a float32 stored as float64, or of
/// a decimal grid.
int commonShift(const Ordering& ordering, std::span<const double> exact) {
  std::uint64_t all = 0;
  for (const double value : exact) {
    const std::int64_t order = ordering.of(value);
    all |= static_cast<std::uint64_t>(order < 0 ? ~order : order);
  }
  return all == 0 ? 0 : std::countr_zero(all);
}

}  // namespace

Bytes encodeExact(const Approximation& known, std::span<const double> exact) {
  const int shift = commonShift(Ordering(known.type), exact);
  RangeEncoder encoder;
  std::vector<double> numbers(exact.begin(), exact.end());
  ExactCoder<RangeEncoder> coder(encoder, known, shift);
  (void)coder.run(numbers, [] { return false; });
  Bytes out{static_cast<std::uint8_t>(shift)};
  const Bytes stream = encoder.finish();
  out.insert(out.end(), stream.begin(), stream.end());
  return out;
}

Result<std::vector<double>> decodeExact(const Approximation& known, ByteView bytes) {
  const auto bad = [] {
    return fail(ErrorCode::kBadValue,
                "a block of exact values contradicts itself; fetch or build the log again");
  };
  if (bytes.empty() || bytes[0] > 63) return bad();
  RangeDecoder decoder(bytes.subspan(1));
  std::vector<double> out(known.integers.size());
  ExactCoder<RangeDecoder> coder(decoder, known, bytes[0]);
  if (!coder.run(out, [&] { return decoder.overrun(); }) || !decoder.atEnd()) return bad();
  return out;
}

}  // namespace qtet
