// Limits on requests and responses, with units and reasons.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace qtet::limits {

using namespace std::chrono_literals;

/// Bytes of a request's line and headers: browsers send under 2 KB, proxies add some.
inline constexpr std::uint32_t kMaxHeaderBytes = 16u << 10;
/// Lines of a request's head: browsers send 15 to 20, proxies add some.
inline constexpr std::size_t kMaxHeaderLines = 100;
/// From a request's first byte to the end of its headers; ends what a slow sender (deliberately or
/// not) can hold.
inline constexpr auto kHeaderTime = 10s;
/// Bytes of a request's body that must arrive within kBodyTime each: so a slow line is served (2
/// KB/s suffice), a dead one is not.
inline constexpr std::size_t kBodyPiece = 64u << 10;
inline constexpr auto kBodyTime = 30s;
/// A kept-alive connection without a request: above the 60 s that common proxies keep theirs, so
/// that they close first.
inline constexpr auto kIdleTime = 75s;
/// Bytes given to one write, each of which must be taken within kWriteTime: so a slow line is
/// served (9 KB/s suffice), a dead one is not.
inline constexpr std::size_t kWritePiece = 256u << 10;
inline constexpr auto kWriteTime = 30s;
/// A body of at most so many bytes goes in one buffer with its head. Copying a page costs less than
/// a second part of the message.
inline constexpr std::size_t kMaxWithHead = 4096;
/// The kernel sends a log's bytes directly from the file if there are at least this many. The
/// second figure is the most at once before other connections have their turn.
inline constexpr std::size_t kMinFromFile = 16u << 10;
inline constexpr std::size_t kMaxFromFile = 1u << 20;
/// For how long, and how many bytes behind the head, are read on after a refusal that closes. So
/// no reset overtakes the answer.
inline constexpr auto kLingerTime = 1s;
inline constexpr std::size_t kLingerBytes = 1u << 20;

}  // namespace qtet::limits
