// Numbers as Fortran programs write them, and a table of numbers that a file gives to its things.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "simplify/mesh/split_mix64.h"

namespace qtet {

/// A real number whose exponent may begin with E, D or its sign alone: "1.5D-3", "1.5-103". One
/// beyond what a double holds is infinite or 0. nullopt: the text is no number.
[[nodiscard]] std::optional<double> fortranReal(std::string_view text);

/// An integer, with or without a sign. nullopt: the text is none, or T does not hold it.
template <class T>
[[nodiscard]] std::optional<T> plainInteger(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || read.ec != std::errc{} || read.ptr != text.data() + text.size())
    return std::nullopt;
  return value;
}

/// An integer from 0 to what an int32 holds: the largest numbers mean no point (kGhost).
[[nodiscard]] inline std::optional<std::uint32_t> plainId(std::string_view text) {
  const auto value = plainInteger<std::int32_t>(text);
  if (!value || *value < 0) return std::nullopt;
  return static_cast<std::uint32_t>(*value);
}

/// Numbers in a file may be any, also multiples of the size of the library's table. The library's
/// own hash of an integer is the integer, so all of these would lie in one bucket.
struct MixedHash {
  std::size_t operator()(std::uint64_t number) const {
    return static_cast<std::size_t>(SplitMix64(number).next());
  }
};

/// From a file's own numbers to places in a list.
using NumberTable = std::unordered_map<std::uint32_t, std::uint32_t, MixedHash>;

}  // namespace qtet
