// Trying dangerous work in a process of its own first.
#pragma once

#include <functional>

namespace qtet {

/// Runs `work` in a copy of this process, whose output goes nowhere, and tells whether it came to
/// its end without being killed by the system (also false if no process could be made). The same
/// work done here afterwards starts from the same memory and so ends the same way. REQUIRES: no
/// other thread of this process holds a lock that `work` needs.
[[nodiscard]] bool survives(const std::function<void()>& work);

}  // namespace qtet
