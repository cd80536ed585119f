// One type for values of two.
#pragma once

#include <string>

namespace qtet {

/// The narrowest type that holds the values of both. A float32 holds integers of 16 bits exactly, a
/// float64 and an int64 all that a mesh may hold (kMaxExactInteger).
[[nodiscard]] std::string commonType(const std::string& a, const std::string& b);

}  // namespace qtet
