// Numbers as text.
#pragma once

#include <array>
#include <cassert>
#include <charconv>
#include <cstddef>
#include <span>
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

/// "0, 0.5 and 12 more". REQUIRES: one time at least.
[[nodiscard]] inline std::string shownTimes(std::span<const double> times) {
  assert(!times.empty());
  constexpr std::size_t kShown = 6;
  std::string out;
  for (std::size_t i = 0; i < times.size() && i < kShown; ++i)
    out += (i == 0 ? "" : ", ") + shortestText(times[i]);
  return out +
         (times.size() > kShown ? " and " + std::to_string(times.size() - kShown) + " more" : "");
}

}  // namespace qtet
