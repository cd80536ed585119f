// Turns any error message into a whole sentence for people.
#pragma once

#include <string>
#include <string_view>

namespace qtet {

/// `text` with a full stop behind it, unless a sentence ends there already.
[[nodiscard]] inline std::string sentence(std::string_view text) {
  std::string out(text);
  if (!out.empty() && out.find_last_of(".!?") != out.size() - 1) out += '.';
  return out;
}

}  // namespace qtet
