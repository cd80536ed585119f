// A logarithm that every machine computes alike.
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace qtet {

/// floor(64 * log2(x)) with a linear mantissa: the exponent and the six bits below the leading one.
/// 0 for what is below 1. REQUIRES finite.
[[nodiscard]] inline int log2Fixed(double x) {
  assert(std::isfinite(x));
  return std::max(static_cast<int>(std::bit_cast<std::int64_t>(x) >> 46) - (1023 << 6), 0);
}

/// The same of an integer.
[[nodiscard]] inline int log2Fixed(std::uint64_t x) {
  if (x >> 53 == 0) return log2Fixed(static_cast<double>(static_cast<std::int64_t>(x)));  // exact
  const int exponent = static_cast<int>(std::bit_width(x)) - 1;
  return exponent * 64 + static_cast<int>(x >> (exponent - 6) & 63);
}

}  // namespace qtet
