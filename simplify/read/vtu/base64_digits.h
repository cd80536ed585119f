// Values of base64's digits (RFC 4648, section 4).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace qtet {

inline constexpr std::uint8_t kNoBase64Digit = 0xFF;

/// By character; that of the filler '=' is kNoBase64Digit.
inline constexpr auto kBase64Digits = [] {
  std::array<std::uint8_t, 256> out{};
  out.fill(kNoBase64Digit);
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kAlphabet.size(); ++i)
    out[static_cast<std::uint8_t>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
  return out;
}();

}  // namespace qtet
