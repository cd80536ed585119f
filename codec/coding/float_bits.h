// Floats as doubles and back, with NaN bit for bit: the processor's own conversion makes a
// signalling NaN quiet.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace qtet {

namespace float_bits {
inline constexpr std::uint32_t kExponent = 0x7F800000u, kFraction = 0x007FFFFFu, kSign = 1u << 31;
inline constexpr std::uint64_t kDoubleExponent = std::uint64_t{0x7FF} << 52;
/// Digits of a double's fraction beyond those of a float's.
inline constexpr int kMoreDigits = 29;
}  // namespace float_bits

/// The double of the same value; a NaN's fraction stands in the upper digits.
[[nodiscard]] inline double widened(float value) {
  using namespace float_bits;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  if ((bits & ~kSign) <= kExponent) return static_cast<double>(value);
  return std::bit_cast<double>(std::uint64_t{bits & kSign} << 32 | kDoubleExponent |
                               std::uint64_t{bits & kFraction} << kMoreDigits);
}

/// The nearest float. A NaN keeps its sign and the upper digits of its fraction, or becomes the
/// quiet NaN where these are 0. widened() undoes it for what widened() made.
[[nodiscard]] inline float narrowed(double value) {
  using namespace float_bits;
  if (!std::isnan(value)) return static_cast<float>(value);
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto fraction = static_cast<std::uint32_t>(bits >> kMoreDigits) & kFraction;
  constexpr std::uint32_t kQuiet = 0x00400000u;
  return std::bit_cast<float>((static_cast<std::uint32_t>(bits >> 32) & kSign) | kExponent |
                              (fraction != 0 ? fraction : kQuiet));
}

}  // namespace qtet
