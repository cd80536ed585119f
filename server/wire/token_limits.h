// Limits on tokens and tickets, with units and reasons.
#pragma once

#include <chrono>
#include <cstddef>

namespace qtet::limits {

using namespace std::chrono_literals;

/// Bytes of the file of tokens.
inline constexpr std::size_t kMaxTokenFileBytes = 1u << 20;
/// From asking for a ticket to the handshake that uses it: one round trip, also of a slow line.
inline constexpr auto kTicketTime = 30s;
/// Unused tickets of one token: a page needs one at a time.
inline constexpr std::size_t kMaxTickets = 256;

}  // namespace qtet::limits
