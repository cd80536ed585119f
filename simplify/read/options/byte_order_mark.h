// The bytes that editors put before a text to say how it is encoded.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "proto/error.h"

namespace qtet {

inline constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";

/// The text behind a mark of UTF-8, if there is one.
[[nodiscard]] constexpr std::string_view withoutMark(std::string_view text) {
  return text.starts_with(kUtf8Mark) ? text.substr(kUtf8Mark.size()) : text;
}

/// Whether the bytes begin with a mark of UTF-16 and a character of ASCII. The mark alone may be a
/// number of a binary file.
[[nodiscard]] constexpr bool isUtf16(std::string_view bytes) {
  if (bytes.size() < 4) return false;
  const bool isLowFirst = bytes.starts_with("\xFF\xFE") && bytes[2] != 0 && bytes[3] == 0,
             isHighFirst = bytes.starts_with("\xFE\xFF") && bytes[2] == 0 && bytes[3] != 0;
  return isLowFirst || isHighFirst;
}
[[nodiscard]] inline std::unexpected<Error> utf16Refused(const std::filesystem::path& path) {
  return fail(ErrorCode::kBadInput,
              path.string() + " is text in UTF-16; save it as UTF-8 or ASCII");
}

/// Passes a mark of UTF-8 at the file's beginning.
inline void passMark(std::ifstream& file) {
  std::string front(kUtf8Mark.size(), '\0');
  file.read(front.data(), static_cast<std::streamsize>(front.size()));
  if (file && front == kUtf8Mark) return;
  file.clear();
  file.seekg(0);
}

/// Whether text follows a mark of UTF-8 in the file.
[[nodiscard]] inline bool isMarked(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  passMark(file);
  return file.tellg() > 0 && file.peek() != std::ifstream::traits_type::eof();
}

}  // namespace qtet
