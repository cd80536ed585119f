// The instants that the values of another one of the same field are predicted from (FORMAT.md,
// "Series"). A log then holds what is left, coded as a field of its own.
#pragma once

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
};

}  // namespace qtet
