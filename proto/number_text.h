// Numbers as text.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace qtet {

/// The shortest text that gives the number back: 0.1, 1e+30. The same in every locale.
template <class Number>
[[nodiscard]] std::string shortestText(Number number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

/// Four digits of it, for a sentence: 0.3333, 1.234e+08.
[[nodiscard]] inline std::string roundedText(double number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number,
                                     std::chars_format::general, 4)
                           .ptr};
}

}  // namespace qtet
