// The library's messages name members of its options, `targetRatio`; the tool says --target-ratio.
#pragma once

#include <string>
#include <vector>

namespace qtet {

/// The text with every member that has an option, between backquotes, as that option. Others stay.
[[nodiscard]] std::string withOptionNames(std::string text);
[[nodiscard]] std::vector<std::string> withOptionNames(std::vector<std::string> texts);

}  // namespace qtet
