#include "simplify/words/error_words.h"

#include <charconv>
#include <cmath>

namespace qtet {
namespace {

std::pair<std::string, ValueBound> parseBound(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const auto refuse = [&](const std::string& what) -> UsageError {
    return UsageError("--error '" + text + "' " + what +
                      "; write NAME=BOUND such as T=0.5, T=0.5K or T=0.1%");
  };
  if (equals == std::string::npos || equals == 0) throw refuse("names no field");
  ValueBound out;
  const char* const end = text.data() + text.size();
  const auto [unit, code] = std::from_chars(text.data() + equals + 1, end, out.value);
  if (code != std::errc() || !std::isfinite(out.value) || !(out.value > 0))
    throw refuse("has no number above 0");
  out.unit.assign(unit, end);
  out.unit.erase(0, out.unit.find_first_not_of(' '));
  return {text.substr(0, equals), out};
}

}  // namespace

void addErrorOption(po::options_description& options) {
  options.add_options()(
      "error", po::value<std::vector<std::string>>(),
      "NAME=BOUND: each value of the last level is within BOUND of the input's, which sets the "
      "field's step and bits: T=0.5 or T=0.5K in its unit, T=0.1% of its range; all=0.1% for "
      "every float field not named; may be given for several fields");
}

ValueBounds valueBoundsOf(const ParsedWords& parsed) {
  ValueBounds out;
  if (parsed.has("error"))
    for (const std::string& text : parsed.get<std::vector<std::string>>("error"))
      out.push_back(parseBound(text));
  return out;
}

}  // namespace qtet
