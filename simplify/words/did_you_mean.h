// The known word that an unknown one was probably meant to be.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace qtet {

/// "; did you mean 'CLOSEST'?", or "" where no known word is near. A known word is near if it
/// begins with `word`. So is one with at most two letters, and at most half of them, missing, too
/// many, other ones or swapped with the next. Case does not count. `mark` stands before the answer,
/// such as "--".
[[nodiscard]] std::string didYouMean(std::string_view word, std::span<const std::string> known,
                                     std::string_view mark = "");

}  // namespace qtet
