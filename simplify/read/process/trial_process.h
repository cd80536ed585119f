// Dangerous work in a process of its own.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

namespace qtet {

enum class TrialEnd : std::uint8_t {
  kDone,         ///< it came to its end
  kCrashed,      ///< the system ended it, or no process could be made
  kStuck,        ///< it read nothing for too long
  kOutOfMemory,  ///< it wanted more than the machine has
};

/// Runs `work` in a copy of this process, whose output goes nowhere, and returns how it ended.
/// `work` must write its findings to a file: its memory goes with the copy. The copy may take as
/// much memory as the machine has. It is ended once it has moved no byte of any file for
/// `patience`, and it ends with this process. REQUIRES: no other thread of this process holds a
/// lock that `work` needs.
[[nodiscard]] TrialEnd tryOut(const std::function<void()>& work, std::chrono::seconds patience);

}  // namespace qtet
