// What happens when a file that is mapped shrinks: reading behind its new end raises SIGBUS, which
// would end the server.
#pragma once

#include <cstdint>

namespace qtet {

/// From now on such a page reads as zeros, for good. What is made of them is refused by its
/// checksum, here or at the client's; the folder is read again soon after. (Given to a socket it
/// fails with EFAULT, and that connection ends.) Call once, before threads.
void guardAgainstBusErrors();
/// Pages that were lost so far.
[[nodiscard]] std::uint64_t lostPages();

}  // namespace qtet
