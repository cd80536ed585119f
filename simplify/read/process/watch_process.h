// Child processes that read files: how long they may read nothing, how much memory they may take.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>

namespace qtet {

/// Whether a process gets on: it reads from or writes to some file.
class ProcessWatch {
 public:
  ProcessWatch(pid_t process, std::chrono::seconds patience)
      : process_(process), patience_(patience) {}
  /// Whether it has moved no byte for the patience, as far as calls of this have seen.
  [[nodiscard]] bool isStuck();

 private:
  pid_t process_;
  std::chrono::seconds patience_;
  std::uint64_t moved_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Waits for the child process `child`: its status as waitpid gives it. Empty: for `patience` it
/// neither read from nor wrote to any file, and was ended.
/// REQUIRES: nobody else waits for it.
[[nodiscard]] std::optional<int> watchProcess(pid_t child, std::chrono::seconds patience);

/// From now on this process may take as much memory as the machine has. Without effect where
/// sanitizers reserve more addresses than that.
void boundMemory();

}  // namespace qtet
