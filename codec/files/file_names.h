// Names and numbers as text that every reader understands.
#pragma once

#include <charconv>
#include <string>
#include <string_view>

namespace qtet {

/// A field's name where only letters, digits and _ may stand, and no digit first; everything else
/// becomes _.
[[nodiscard]] inline std::string identifier(std::string_view name) {
  std::string out;
  for (const char c : name)
    out += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
  return out.empty() || (out[0] >= '0' && out[0] <= '9') ? "_" + out : out;
}

/// Underscores that tell identifiers apart; behind them stands a number. With underscores alone
/// 8,192 names of punctuation took 52 s and 34 MB.
inline constexpr int kMaxUnderscores = 4;

/// The same for the next of several names. One that `taken` holds gets underscores behind it until
/// it is new. After kMaxUnderscores of them comes a number.
template <class Names>
[[nodiscard]] std::string newIdentifier(std::string_view name, Names& taken) {
  std::string out = identifier(name);
  for (int i = 0; i < kMaxUnderscores; ++i) {
    if (taken.insert(out).second) return out;
    out += "_";
  }
  // as many as are taken: larger for each name, so that hardly one is tried twice
  for (std::size_t number = taken.size();; ++number)
    if (std::string numbered = out + std::to_string(number); taken.insert(numbered).second)
      return numbered;
}

/// A field's name in VTK's legacy format, which has no white space in names: VTK's own way round it
/// is that of URLs.
[[nodiscard]] inline std::string vtkName(std::string_view name) {
  constexpr const char* kHex = "0123456789ABCDEF";
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > 0x20 && byte < 0x7F && c != '%' && c != '"') {
      out += c;
    } else {
      out += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return out.empty() ? "%20" : out;
}

/// A text inside an attribute's double quotes, or between tags. XML 1.0 has no way to write other
/// control characters, so these become '?'.
[[nodiscard]] inline std::string xmlText(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\t': out += "&#9;"; break;
      case '\n': out += "&#10;"; break;
      case '\r': out += "&#13;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return out;
}

/// Appends the shortest text that reads as the same number.
template <class T>
void appendShortest(std::string& out, T value) {
  char text[32];
  const auto written = std::to_chars(text, text + sizeof text, value);
  out.append(text, written.ptr);
}

}  // namespace qtet
