// Splits integers into a symbol and a few digits (FORMAT.md, "Value blocks"). Values of 12 bits
// have fewer than a hundred symbols, so an entropy coder's table pays for them. The digits below
// are noise and are stored as they are.
#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {
namespace digits {

// A magnitude below 2^kWhole is its own symbol; above, its leading bit and the two below it make
// the symbol.
inline constexpr int kWhole = 2;
inline constexpr int kMaxBits = 31;
inline constexpr std::int32_t kSymbols = (1 << kWhole) + 2 * (kMaxBits - kWhole);

struct Split {
  std::int32_t symbol = 0;
  std::uint32_t digits = 0;
  int count = 0;  ///< bits of `digits`
};

/// REQUIRES |value| < 2^kMaxBits.
[[nodiscard]] inline Split split(std::int32_t value) {
  const std::uint32_t magnitude =
      value < 0 ? 0u - static_cast<std::uint32_t>(value) : static_cast<std::uint32_t>(value);
  const int bits = std::bit_width(magnitude);
  assert(bits <= kMaxBits);
  if (bits <= kWhole) return {value, 0, 0};
  const int count = bits - kWhole;
  const auto symbol =
      static_cast<std::int32_t>((1 << kWhole) + 2 * (count - 1) + ((magnitude >> count) & 1));
  return {value < 0 ? -symbol : symbol, magnitude & ((1u << count) - 1), count};
}

/// How many digits follow a symbol. REQUIRES |symbol| < kSymbols.
[[nodiscard]] inline int countOf(std::int32_t symbol) {
  assert(-kSymbols < symbol && symbol < kSymbols);
  const std::int32_t magnitude = symbol < 0 ? -symbol : symbol;
  return magnitude < 1 << kWhole ? 0 : 1 + ((magnitude - (1 << kWhole)) >> 1);
}

/// REQUIRES |symbol| < kSymbols, digits < 2^countOf(symbol).
[[nodiscard]] inline std::int32_t join(std::int32_t symbol, std::uint32_t digits) {
  const std::int32_t magnitude = symbol < 0 ? -symbol : symbol;
  assert(magnitude < kSymbols && (magnitude >= 1 << kWhole || digits == 0));
  if (magnitude < 1 << kWhole) return symbol;
  const int count = countOf(symbol);
  assert(digits >> count == 0);
  const std::uint32_t leading = 2 + ((static_cast<std::uint32_t>(magnitude) - (1u << kWhole)) & 1);
  const auto value = static_cast<std::int32_t>(leading << count | digits);
  return symbol < 0 ? -value : value;
}

}  // namespace digits

/// The symbols of all values, and their digits back to back from the lowest bit of the first byte
/// on. Unused bits are 0.
struct SymbolsAndDigits {
  std::vector<std::int32_t> symbols;
  Bytes digits;
};
/// REQUIRES every |value| < 2^digits::kMaxBits.
[[nodiscard]] SymbolsAndDigits splitValues(std::span<const std::int32_t> values);

/// The inverse. Errors: bad-value (a symbol out of range; digits that are too few, too many, or not
/// 0 beyond the last).
[[nodiscard]] Result<std::vector<std::int32_t>> joinValues(std::span<const std::int32_t> symbols,
                                                           ByteView digits);

}  // namespace qtet
