// Limits on connections and handshakes, with units and reasons.
#pragma once

#include <chrono>
#include <cstddef>

namespace qtet::limits {

using namespace std::chrono_literals;

/// Connections at a time, HTTP and WebSocket together. An idle one takes 3 KB (HTTP) or 7 KB
/// (WebSocket) (measured), 28 MB in all, more with TLS. The number stays below the usual hard limit
/// of 4,096 or more open files, less some for the logs.
inline constexpr std::size_t kMaxConnections = 4000;
/// Connections at a time of one address: browsers open 6 and one WebSocket a page; a company behind
/// one address has some pages open.
inline constexpr std::size_t kMaxConnectionsPerAddress = 256;
/// Requests a second of one address: somebody who reads a log chunk by chunk (16 KB and more) comes
/// to 30 MB/s.
inline constexpr unsigned kMaxRequestsPerSecond = 2000;
/// Processor time that an address may use each second without owing any of it: for answers,
/// handshakes and views. A viewer takes some milliseconds to open a mesh.
inline constexpr auto kProcessorTimePerSecond = 200ms;
/// An address that owes this much is refused. A thousand people behind one address owe as much
/// if they open six meshes of 5 ms each at once. Fewer only wait behind others.
inline constexpr auto kMaxOwedTime = 30s;
/// An address that owes more than this waits for its turn behind those that owe less.
inline constexpr auto kMaxFreeTime = 1ms;
/// A turn that takes more processor time than this is counted (qtet_long_turns_total): all other
/// clients of the thread have waited for it.
inline constexpr auto kLongTurn = 5ms;
/// How much later it counts as come for each second that it owes. Its own requests at a time cost
/// more than it owes, so this is above one.
inline constexpr int kTurnsBehind = 8;
/// How long a stream rests whose address has used up its processor time.
inline constexpr auto kOverdrawnRest = 50ms;
/// Addresses remembered before those that do nothing are forgotten: 150 bytes each.
inline constexpr std::size_t kMaxRememberedAddresses = 100'000;
/// Seconds after which a client that was turned away (503) is asked to come back.
inline constexpr unsigned kRetryAfterSeconds = 2;
/// How long `accept` rests when the system has no file or memory left for another connection: after
/// the first failure, and after each further one.
inline constexpr auto kFirstAcceptRest = 1ms;
inline constexpr auto kAcceptRest = 100ms;
/// How often this is logged.
inline constexpr auto kAcceptWarningInterval = 10s;

// ---- TLS

/// Handshakes under way, from the server's answer to the hello until the client's last message: 43
/// KB each (measured), 22 MB in all. Later clients wait in line, which takes only the connection.
inline constexpr std::size_t kMaxHandshakes = 512;
/// Those of one address, with its connections in line: in a round trip of 100 ms they open 640
/// connections a second. Seven addresses that stall leave places to others.
inline constexpr std::size_t kMaxHandshakesPerAddress = 64;
/// How long a handshake keeps its place when others want it: a round trip of a poor line with a
/// packet lost and sent again.
inline constexpr auto kHandshakePatience = 3s;

}  // namespace qtet::limits
