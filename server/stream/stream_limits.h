// Limits on a stream, with units and reasons.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace qtet::limits {

using namespace std::chrono_literals;

/// Messages a second: a client that grants credit for every block of 16 KB reaches it at 32 MB/s.
inline constexpr unsigned kMaxMessagesPerSecond = 2000;
/// `open`s a second: each makes a plan over the whole chunk table; a person cannot choose fields as
/// fast.
inline constexpr unsigned kMaxOpensPerSecond = 50;
/// `target`s and `resume`s with `have` a second; each of them makes a plan. Nobody moves a slider
/// faster than a screen of 240 Hz shows it.
inline constexpr unsigned kMaxChangesPerSecond = 250;
/// Answers waiting for a client that sends but does not read.
inline constexpr std::size_t kMaxQueuedAnswers = 256;
/// Pings a second: browsers send none.
inline constexpr unsigned kMaxPingsPerSecond = 20;
/// Frames of one write, and payload bytes after which no further frame joins it. A system call for
/// every chunk would cost as much as the chunk. But data already written belongs to the old order
/// when a view changes.
inline constexpr std::size_t kFramesPerWrite = 16;
inline constexpr std::size_t kBytesPerWrite = 128u << 10;
/// Bytes of a frame's payload beyond which no further block joins it. Frames are then frequent
/// enough for progress on a slow line (2 s at 1 Mbit/s), and so large that their own cost vanishes.
inline constexpr std::uint32_t kFramePayload = 256u << 10;
/// How long a client may take to answer the server's close: within the grace time of the server's
/// end.
inline constexpr auto kClosingTime = 5s;
/// After half of this silence a client is pinged; after the other half it is given up.
inline constexpr auto kSilenceTime = 30s;

}  // namespace qtet::limits
