#include "proto/utf8.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace qtet {
namespace {

bool isContinuation(char c) { return (static_cast<std::uint8_t>(c) & 0xC0) == 0x80; }

/// Bytes of the sound character at the front; 0: there is none.
std::size_t characterBytes(std::string_view text) {
  const auto first = static_cast<std::uint8_t>(text[0]);
  if (first < 0x80) return 1;
  const std::size_t size = first < 0xC2   ? 0
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 0;
  if (size == 0 || text.size() < size) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if (!isContinuation(text[i])) return 0;
  const auto second = static_cast<std::uint8_t>(text[1]);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  // surrogates, above U+10FFFF
  const bool beyond = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return overlong || beyond ? 0 : size;
}

}  // namespace

bool isUtf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t size = characterBytes(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
}

bool hasControl(std::string_view text) {
  constexpr std::array<std::string_view, 2> kSeparators = {"\xE2\x80\xA8", "\xE2\x80\xA9"};
  for (; !text.empty(); text.remove_prefix(1)) {
    const auto first = static_cast<std::uint8_t>(text[0]);
    if (first < 0x20 || first == 0x7F) return true;
    if (first == 0xC2 && text.size() > 1 && isContinuation(text[1]) &&
        static_cast<std::uint8_t>(text[1]) < 0xA0)
      return true;
    for (const std::string_view separator : kSeparators)
      if (text.starts_with(separator)) return true;
  }
  return false;
}

std::string soundUtf8(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t size = characterBytes(text);
    out += size > 0 ? text.substr(0, size) : "?";
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return out;
}

}  // namespace qtet
