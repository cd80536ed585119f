// The digest of a log, as it stands in addresses and messages.
#pragma once

#include <cstddef>
#include <string_view>

namespace qtet {

/// Hexadecimal digits of a SHA-256.
inline constexpr std::size_t kDigestCharacters = 64;

/// 64 lower-case hexadecimal digits.
[[nodiscard]] inline bool isLogDigest(std::string_view text) {
  return text.size() == kDigestCharacters &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace qtet
