// Child processes that read files: how long they may read nothing, how much memory they may take.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>

namespace qtet {

/// Waits for the child process `child`: its status as waitpid gives it. Empty: for `patience` it
/// neither read from nor wrote to any file, and was ended.
/// REQUIRES: nobody else waits for it.
[[nodiscard]] std::optional<int> watchProcess(pid_t child, std::chrono::seconds patience);

/// From now on this process may take as much memory as the machine has. Without effect where
/// sanitizers reserve more addresses than that.
void boundMemory();

}  // namespace qtet
