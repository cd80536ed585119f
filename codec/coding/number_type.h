// Numbers of the types that fields have, as the bytes of a file.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "proto/bytes.h"

namespace qtet {

/// Appends `value` in the byte order `order`, independent of the machine's.
template <std::endian order = std::endian::little, class T>
void appendNumber(Bytes& out, T value) {
  if constexpr (sizeof(T) == 1) {
    out.push_back(static_cast<std::uint8_t>(value));
  } else if constexpr (std::endian::native == order) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    out.insert(out.end(), bytes, bytes + sizeof(T));
  } else {
    auto bytes = std::bit_cast<std::array<std::uint8_t, sizeof(T)>>(value);
    std::reverse(bytes.begin(), bytes.end());
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
}

inline void appendText(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
}

/// A type by its names in the manifest (float32, float64, int8 ... uint64), in VTK's XML and legacy
/// files and in numpy's (little-endian).
struct NumberType {
  std::string_view name, xmlName, legacyName, numpyName;
  std::uint64_t sizeBytes;
  /// Each value rounded (nearestInteger) and clamped to the type; NaN becomes 0 in an integer.
  void (*append)(Bytes&, std::span<const double>);
  void (*appendBigEndian)(Bytes&, std::span<const double>);
};

/// Other names are float64.
[[nodiscard]] const NumberType& numberType(std::string_view name);

}  // namespace qtet
