// Bounds a reader's work by the bytes received (FORMAT.md, "Security"). Decisions that cost next to
// nothing must not make it work for minutes on a small file.
#pragma once

#include <cstdint>

#include "proto/limits.h"

namespace qtet {

/// Counts steps (kMaxStepsPerByte says which) against structure bytes.
class WorkMeter {
 public:
  void grant(std::uint64_t structureBytes) { allowed_ += kMaxStepsPerByte * structureBytes; }
  void spend(std::uint64_t steps) { spent_ += steps; }
  [[nodiscard]] bool isExceeded() const { return spent_ > allowed_; }
  /// So far.
  [[nodiscard]] std::uint64_t steps() const { return spent_; }

 private:
  std::uint64_t spent_ = 0;
  std::uint64_t allowed_ = kMaxStepsPerByte * kFreeStepBytes;
};

}  // namespace qtet
