// How the values of one instant are predicted from other instants of the same field (FORMAT.md,
// "Series"). A log then holds what is left, coded as a field of its own.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace qtet {

struct TimePrediction {
  /// A field of a smaller number, and what it counts, in 1 / 2^kWeightBits.
  struct Parent {
    std::uint16_t field = 0;
    std::int8_t weight = 0;
    bool operator==(const Parent&) const = default;
  };
  static constexpr std::size_t kMaxParents = 4;
  static constexpr int kWeightBits = 4;
  static constexpr int kOne = 1 << kWeightBits;

  std::array<Parent, kMaxParents> parents{};
  std::uint8_t count = 0;  ///< 0: the field is coded as it is

  [[nodiscard]] bool isNone() const { return count == 0; }
  [[nodiscard]] std::span<const Parent> all() const { return std::span(parents).first(count); }
  bool operator==(const TimePrediction&) const = default;

  /// The weighted sum of the parents' values, which `at(field)` gives. Where one is missing, it is
  /// the first that is not, or 0.
  template <class At>
  [[nodiscard]] std::int64_t predict(const At& at, std::int32_t missing) const {
    std::int64_t sum = std::int64_t{1} << (kWeightBits - 1), present = 0;
    bool hasPresent = false, isWhole = true;
    for (const Parent& parent : all()) {
      const std::int32_t value = at(parent.field);
      if (value == missing) {
        isWhole = false;
        continue;
      }
      if (!hasPresent) present = value, hasPresent = true;
      sum += std::int64_t{parent.weight} * value;
    }
    return isWhole ? sum >> kWeightBits : present;
  }

  /// The value of a difference that is not missing. Values are held within +-2^30, not refused: the
  /// parents' values on the way depend on the order in which blocks come.
  template <class At>
  [[nodiscard]] std::int32_t restore(std::int32_t difference, const At& at,
                                     std::int32_t missing) const {
    constexpr std::int64_t kLargest = std::int64_t{1} << 30;
    return static_cast<std::int32_t>(
        std::clamp(difference + predict(at, missing), -kLargest, kLargest));
  }
};

}  // namespace qtet
