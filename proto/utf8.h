// Texts from outside: whether they are UTF-8, and what is shown where they are not.
#pragma once

#include <string>
#include <string_view>

namespace qtet {

/// UTF-8 as RFC 3629 has it: no overlong forms, no surrogates, nothing above U+10FFFF, nothing cut
/// off.
[[nodiscard]] bool isUtf8(std::string_view text);
/// `text` with a question mark for each byte that belongs to no sound character: as long as it was.
[[nodiscard]] std::string soundUtf8(std::string_view text);

/// Whether it has a character that moves, ends or hides a line where it is shown: C0, DEL, C1, or
/// the separators U+2028 and U+2029.
[[nodiscard]] bool hasControl(std::string_view text);

}  // namespace qtet
