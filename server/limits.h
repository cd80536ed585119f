// What the server allows a client, and itself: every bound with its unit and its reason.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace qtet::limits {

using namespace std::chrono_literals;

// ---- connections

/// Connections at a time, HTTP and WebSocket together: 12 KB each when idle (measured), 48 MB in all, and below the usual hard limit
/// of 4,096 or more open files once some are set aside for the logs.
inline constexpr std::size_t kMaxConnections = 4000;
/// Seconds after which a client that was turned away (503) is asked to come back.
inline constexpr unsigned kRetryAfterSeconds = 2;
/// How long `accept` rests when the system has no file or memory left for one more connection.
inline constexpr auto kAcceptRest = 100ms;

// ---- HTTP

/// Bytes of a request's line and headers: browsers send under 2 KB, proxies add some.
inline constexpr std::uint32_t kMaxHeaderBytes = 16u << 10;
/// From a request's first byte to the end of its headers; ends what a slow sender (deliberately or not) can hold.
inline constexpr auto kHeaderTime = 10s;
/// A kept-alive connection without a request: above the 60 s that common proxies keep theirs, so that they close first.
inline constexpr auto kIdleTime = 75s;
/// Bytes given to one write, each of which must be taken within kWriteTime: so a slow line is served (9 KB/s suffice), a dead one is not.
inline constexpr std::size_t kWritePiece = 256u << 10;
inline constexpr auto kWriteTime = 30s;
/// After a refusal that closes, how long and how much is still read, so that the answer is not lost to a reset.
inline constexpr auto kLingerTime = 1s;
inline constexpr std::size_t kLingerBytes = 1u << 20;

// ---- levels

/// Levels being made, waiting or being sent at a time; each may hold a whole mesh in memory.
inline constexpr std::size_t kMaxLevelJobs = 8;
/// Threads that make them, beside the I/O threads.
inline constexpr std::size_t kLevelThreads = 1;

// ---- the viewer's files, held in memory

/// Files: the built viewer has about twenty.
inline constexpr std::size_t kMaxViewerFiles = 1000;
/// Bytes of all of them: the built viewer has about one MiB.
inline constexpr std::uintmax_t kMaxViewerBytes = 64u << 20;

// ---- WebSocket

/// Messages a second: a client that grants credit for every block of 16 KB reaches it at 32 MB/s.
inline constexpr unsigned kMaxMessagesPerSecond = 2000;
/// `open`s a second: each makes a plan over the whole chunk table; a person cannot choose fields as fast.
inline constexpr unsigned kMaxOpensPerSecond = 50;
/// Answers waiting for a client that sends but does not read.
inline constexpr std::size_t kMaxQueuedAnswers = 256;
/// Bytes of a frame's payload beyond which no further block is put into it: frequent enough for progress on a slow line (2 s at
/// 1 Mbit/s), large enough that the cost of a frame vanishes.
inline constexpr std::uint32_t kFramePayload = 256u << 10;
/// The handshake, and the closing one.
inline constexpr auto kHandshakeTime = 10s;
/// Silence after which a client is given up; a ping goes out at half of it.
inline constexpr auto kSilenceTime = 30s;

// ---- the end

/// From SIGTERM to the end: what responses under way, and closing handshakes, have left. Below the 10 s of common supervisors.
inline constexpr auto kGraceTime = 8s;

}  // namespace qtet::limits
