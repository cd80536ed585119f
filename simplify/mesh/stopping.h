// Work that is broken off because its result is no longer wanted.
#pragma once

#include <atomic>
#include <cstddef>
#include <stop_token>

#include "proto/error.h"

namespace qtet {

/// Thrown deep inside the work. It stays inside: orCancelled() stands at the border.
struct Stopped {};

/// Cells or points between two looks at whether to stop.
inline constexpr std::size_t kLookEvery = 65536;

inline void throwIfStopped(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Stopped();
}

/// The Result of work(), or ErrorCode::kCancelled where it threw Stopped.
template <class Work>
[[nodiscard]] auto orCancelled(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const Stopped&) {
    return cancelled();
  }
}

/// A stop token's word for code that knows atomics alone, as the codec that is compiled for the
/// browser.
class StopFlag {
 public:
  explicit StopFlag(const std::stop_token& stop) : set_(stop, Set{flag_}) {}
  [[nodiscard]] const std::atomic<bool>* get() const { return &flag_; }

 private:
  struct Set {
    std::atomic<bool>& flag;
    void operator()() const { flag = true; }
  };
  std::atomic<bool> flag_{false};
  std::stop_callback<Set> set_;
};

}  // namespace qtet
