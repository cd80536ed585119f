// Limits on tokens and tickets, with units and reasons.
#pragma once

#include <chrono>
#include <cstddef>

namespace qtet::limits {

using namespace std::chrono_literals;

/// Bytes of the file of tokens.
inline constexpr std::size_t kMaxTokenFileBytes = 1u << 20;
/// Characters of a token that is given as it is: as many as 16 random bytes in base64, below which
/// it could be guessed.
inline constexpr std::size_t kMinTokenCharacters = 22;
/// Characters of a token's name: a line of the log stays short.
inline constexpr std::size_t kMaxTokenName = 64;
/// Characters of a ticket, all hexadecimal: issuer, end, nonce, the token's digest, signature.
inline constexpr std::size_t kTicketCharacters = 16 + 16 + 64 + 64 + 64;
/// From asking for a ticket to the handshake that uses it: one round trip, also of a slow line.
inline constexpr auto kTicketTime = 30s;
/// Unused tickets of one token: a page needs one at a time.
inline constexpr std::size_t kMaxTickets = 256;

}  // namespace qtet::limits
