// The system calls that are left to a process that decodes for strangers.
#pragma once

namespace qtet {

/// From now on no thread of this process can open a file, a socket or another process, or make
/// memory executable. All calls but those of computing with open files fail with EPERM. False:
/// this kernel has no such filter, and nothing has changed.
[[nodiscard]] bool confine();

}  // namespace qtet
