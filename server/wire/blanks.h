// Blanks round the values of headers: RFC 9110's optional whitespace.
#pragma once

#include <string_view>

namespace qtet {

inline constexpr std::string_view kBlanks = " \t";

[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace qtet
