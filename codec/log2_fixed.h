// A logarithm that every machine computes alike.
#pragma once

#include <bit>
#include <cstdint>

namespace qtet {

/// floor(64 * log2(x)) with a linear mantissa; 0 for 0.
[[nodiscard]] inline int log2Fixed(std::uint64_t x) {
  if (x == 0) return 0;
  const int exponent = static_cast<int>(std::bit_width(x)) - 1;
  const std::uint64_t mantissa = exponent >= 6 ? x >> (exponent - 6) : x << (6 - exponent);
  return exponent * 64 + static_cast<int>(mantissa & 63);
}

/// The same of a double: its exponent and the six bits below the leading one. 0 for what is below 1. REQUIRES finite.
[[nodiscard]] inline int log2Fixed(double x) {
  return x < 1 ? 0 : static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 46) - (1023 << 6);
}

}  // namespace qtet
