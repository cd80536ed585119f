// How long our own readers may work on a file.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

#include "proto/error.h"

namespace qtet {

/// A reader of ours has `patience`, and a second for each kSlowestBytesPerSecond of its file. So a
/// large file is never given up, and a small one that unfolds into much work is. A default value
/// has no end. Thread-safe.
class ReadingTime {
 public:
  using Clock = std::chrono::steady_clock;
  /// The slowest of our readers gets on a hundred times as fast on a machine that is busy.
  static constexpr std::uint64_t kSlowestBytesPerSecond = 128'000;

  ReadingTime() = default;
  /// Begins now.
  ReadingTime(std::chrono::seconds patience, std::uint64_t fileBytes);

  /// The reading, which began before, has another file of so many bytes.
  void addFile(std::uint64_t fileBytes);

  [[nodiscard]] bool isOver() const;
  /// Says why reading ended and what to do, to stand behind the file's name.
  [[nodiscard]] std::string text() const;
  /// Error: bad-input (it is over).
  [[nodiscard]] Status check(const std::filesystem::path& path) const;

 private:
  std::chrono::seconds patience_{0};
  Clock::time_point end_ = Clock::time_point::max();
};

}  // namespace qtet
