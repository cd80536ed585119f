#pragma once

#include <algorithm>
#include <map>
#include <string>

namespace qtet {

/// The text of a Boost.Program_options error, safe for any words of the user. Its own what()
/// replaces placeholders until none is left. It never ends if a word holds the placeholder itself:
/// `--x%original_token%`. This function masks each % of a word meanwhile. `Named` is
/// boost::program_options::error_with_option_name. It is a parameter because this room does not
/// include Boost.
template <class Named, class Error>
std::string optionErrorText(Error& error) {
  struct Open : Named {
    static std::map<std::string, std::string> of(const Named& named) {
      return named.*(&Open::m_substitutions);
    }
  };
  constexpr char kMask = '\x01';
  const auto replaced = [](std::string text, char from, char to) {
    std::ranges::replace(text, from, to);
    return text;
  };
  if (auto* named = dynamic_cast<Named*>(&error)) {
    for (const auto& [placeholder, word] : Open::of(*named))
      named->set_substitute(placeholder, replaced(word, '%', kMask));
  }
  return replaced(error.what(), kMask, '%');
}

}  // namespace qtet
