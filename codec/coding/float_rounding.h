// Rounding a double to the nearest float, for certain.
#pragma once

namespace qtet {

/// `x` as float32 stores it. g++ 12 at -O2 loses conversions to float and back on two doubles side
/// by side. (Its SLP vectoriser does this; clang and -fno-tree-slp-vectorize keep them.) So the
/// float goes through memory that the optimiser must not look into.
[[nodiscard]] inline double roundedToFloat(double x) {
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}

}  // namespace qtet
