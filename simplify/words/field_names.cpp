#include "simplify/words/field_names.h"

#include <cstddef>
#include <utility>

#include "simplify/words/usage_error.h"

namespace qtet {

std::optional<std::vector<std::string>> parseFieldNames(const std::string& text) {
  if (text == "all") return std::nullopt;
  std::vector<std::string> names;
  if (text == "none") return names;
  std::string name;
  const auto take = [&] {
    if (name.empty())
      throw UsageError("--fields '" + text +
                       "' holds an empty name; give all, none, or names between commas");
    names.push_back(std::exchange(name, {}));
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool isEscape =
        text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == ',' || text[i + 1] == '\\');
    if (text[i] == ',')
      take();
    else
      name += text[isEscape ? ++i : i];
  }
  if (!name.empty()) take();
  if (names.empty()) throw UsageError("--fields is empty; give all, none, or names between commas");
  return names;
}

}  // namespace qtet
