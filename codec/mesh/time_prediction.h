// How the values of one instant follow from those of its parents (time_parents.h).
#pragma once

#include <algorithm>
#include <cstdint>

#include "codec/mesh/time_parents.h"

namespace qtet {

/// A restored value stays within this on both sides of 0, as far as Draco codes integers.
inline constexpr std::int64_t kMaxRestored = std::int64_t{1} << 30;

/// The weighted sum of the parents' values, which `at(field)` gives. Where one is missing, it is
/// the first that is not, or 0.
template <class At>
[[nodiscard]] std::int64_t predictInTime(const TimePrediction& prediction, const At& at,
                                         std::int32_t missing) {
  std::int64_t sum = std::int64_t{1} << (TimePrediction::kWeightBits - 1), present = 0;
  bool hasPresent = false, isWhole = true;
  for (const TimePrediction::Parent& parent : prediction.all()) {
    const std::int32_t value = at(parent.field);
    if (value == missing) {
      isWhole = false;
      continue;
    }
    if (!hasPresent) present = value, hasPresent = true;
    sum += std::int64_t{parent.weight} * value;
  }
  return isWhole ? sum >> TimePrediction::kWeightBits : present;
}

/// The value of a difference that is not missing. Values are held within +-2^30, not refused: the
/// parents' values on the way depend on the order in which blocks come.
template <class At>
[[nodiscard]] std::int32_t restoreInTime(const TimePrediction& prediction, std::int32_t difference,
                                         const At& at, std::int32_t missing) {
  return static_cast<std::int32_t>(
      std::clamp(difference + predictInTime(prediction, at, missing), -kMaxRestored, kMaxRestored));
}

}  // namespace qtet
