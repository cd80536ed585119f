// Words of text files in ASCII: without blanks, in capitals, as a message shows them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "proto/trimmed.h"

namespace qtet {

inline constexpr std::string_view kBlanks = " \t\r\f\v";

[[nodiscard]] constexpr std::string_view trimmed(std::string_view text) {
  return trimmed(text, kBlanks);
}

[[nodiscard]] constexpr char capital(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}
[[nodiscard]] inline std::string capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = capital(c);
  return out;
}

/// A field of a file in a message: the beginning, without what no terminal shows.
[[nodiscard]] inline std::string shownField(std::string_view field) {
  constexpr std::size_t kMost = 24;
  std::string out(field.substr(0, kMost));
  for (char& c : out) c = c < ' ' || c > '~' ? '?' : c;
  return out;
}
/// The message of a field that is not what it should be.
[[nodiscard]] inline std::string misplacedField(std::string_view field, const char* what) {
  return "'" + shownField(field) + "' is where " + what +
         " should be; the file is damaged, export it again";
}

}  // namespace qtet
