// How a value becomes an integer of a field's type (FORMAT.md, "Manifest"): one rule for everything
// that reads and writes such values.
#pragma once

#include <cmath>

namespace qtet {

/// The nearest integer, halves up; what is not finite stays what it is.
[[nodiscard]] inline double nearestInteger(double value) {
  // Not floor(value + 0.5), which near 2^53 is another number.
  const double below = std::floor(value);
  return value - below >= 0.5 ? below + 1 : below;
}

}  // namespace qtet
