// Words and numbers on their way to people: those of files that strangers made, counts, and how
// wide a text is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace qtet {

/// The text with U+FFFD for every control character (C0, DEL, C1), which a terminal might obey:
/// colours, titles, keys. A byte that is no UTF-8 becomes a question mark. With `keepLines` line
/// feeds stay.
[[nodiscard]] std::string printable(std::string_view text, bool keepLines = false);

/// How many characters of UTF-8 the text has, which is its width in columns where none is a wide or
/// a combining one.
[[nodiscard]] std::size_t textWidth(std::string_view text);

/// A line of help has at most so many columns, as wide as a terminal may well be.
inline constexpr std::size_t kHelpColumns = 100;

/// The text's paragraphs, filled to lines of at most kHelpColumns; a longer word has a line to
/// itself. A paragraph begins at the text's start, behind an empty line, and at a line that begins
/// with a dash. Its lines from the second on begin with `indent`. A line "  name  text" is an item,
/// and its further lines begin below the text.
[[nodiscard]] std::string filled(std::string_view text, std::string_view indent = "");

/// 1234567 as "1,234,567".
[[nodiscard]] std::string grouped(std::uint64_t number);

/// "1 tetrahedron", "1,234 tetrahedra": grouped(number) and the word for so many.
[[nodiscard]] std::string counted(std::uint64_t number, std::string_view one,
                                  std::string_view many);

}  // namespace qtet
