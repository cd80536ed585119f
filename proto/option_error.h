#pragma once

#include <algorithm>
#include <map>
#include <string>

namespace qtet {

/// What a Boost.Program_options error says, whatever words were given. Its what() puts the words
/// into a template for as long as their placeholder is found, and so never ends when a word holds
/// the placeholder itself: `--x%original_token%`. Here each % of a word is masked meanwhile.
/// `Named` is boost::program_options::error_with_option_name: this room knows no Boost, which those
/// that have options bring.
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
