// The words --error NAME=BOUND of `qtet simplify`, `add-field` and `add-steps`.
#pragma once

#include "simplify/clean/value_bounds.h"
#include "simplify/words/parsed_words.h"

namespace qtet {

void addErrorOption(po::options_description& options);
/// A BOUND is "0.5", "0.5 K" or "0.1%", behind the last '='. Throws UsageError.
[[nodiscard]] ValueBounds valueBoundsOf(const ParsedWords& parsed);

}  // namespace qtet
