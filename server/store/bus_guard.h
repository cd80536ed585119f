// Survives the shrinking of a mapped file: a read behind its new end raises SIGBUS, which would end
// the server.
#pragma once

#include <cstdint>

namespace qtet {

/// From now on such a page reads as zeros, for good. A checksum then refuses the data, here or at
/// the client's, and the folder is read again soon after. (A socket that sends the page fails with
/// EFAULT, and that connection ends.) Call once, before threads.
void guardAgainstBusErrors();
/// Pages that were lost so far.
[[nodiscard]] std::uint64_t lostPages();

}  // namespace qtet
