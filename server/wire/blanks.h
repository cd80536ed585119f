// Blanks round the values of headers: RFC 9110's optional whitespace.
#pragma once

#include <string_view>

#include "proto/trimmed.h"

namespace qtet {

inline constexpr std::string_view kHeaderBlanks = " \t";

}  // namespace qtet
