// Times as programs write them into lists of files and names of folders.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "proto/number_text.h"

namespace qtet {

/// The finite number that the whole text is.
[[nodiscard]] inline std::optional<double> plainTime(std::string_view text) {
  double time = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), time);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(time))
    return std::nullopt;
  return time;
}

/// The same with blanks around it, a leading plus, and the D of Fortran's exponents.
[[nodiscard]] inline std::optional<double> timeIn(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return std::nullopt;
  text = text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  std::string plain(text);
  if (const std::size_t exponent = plain.find_first_of("dD"); exponent != std::string::npos)
    plain[exponent] = 'e';
  return plainTime(plain);
}

}  // namespace qtet
