// Numbers that follow from a seed, the same on every machine.
#pragma once

#include <chrono>
#include <cstdint>
#include <random>
#include <string>

namespace qtet::simulator {

/// The standard fixes the engine's numbers, and not those of its distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// From 0 to `end` - 1. REQUIRES: end > 0.
  std::uint64_t below(std::uint64_t end) { return engine_() % end; }
  /// From `first` to `last`.
  std::uint64_t between(std::uint64_t first, std::uint64_t last) {
    return first + below(last - first + 1);
  }
  std::chrono::nanoseconds between(std::chrono::nanoseconds first, std::chrono::nanoseconds last) {
    return std::chrono::nanoseconds(between(static_cast<std::uint64_t>(first.count()),
                                            static_cast<std::uint64_t>(last.count())));
  }
  /// True `times` of 1,000 times.
  bool chance(std::uint64_t times) { return below(1000) < times; }
  std::string bytes(std::size_t count) {
    std::string out(count, '\0');
    for (char& byte : out) byte = static_cast<char>(engine_());
    return out;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace qtet::simulator
