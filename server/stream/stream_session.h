// One WebSocket on `/v1/stream`: carries what StreamProtocol says, and keeps the socket alive and
// within bounds.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <string>

#include "server/store/mesh_store.h"
#include "server/stream/stream_limits.h"
#include "server/stream/stream_report.h"
#include "server/wire/access.h"
#include "server/wire/http_limits.h"
#include "server/wire/peer.h"

namespace qtet {

/// A handshake that was found good.
struct StreamHandshake {
  std::string key;         ///< Sec-WebSocket-Key
  std::string firstBytes;  ///< what came behind its head already
  MayRead mayRead{};       ///< which meshes it may open; empty: all
  /// After which it is given up.
  std::chrono::milliseconds silence = limits::kSilenceTime, write = limits::kWriteTime;
  bool unpaced = false;  ///< as Services has it
  StreamRequest request{};
};

/// Answers the handshake and serves until the socket ends. Runs on the socket's executor, which
/// must be a single thread or a strand.
/// `log` may be nullptr.
boost::asio::awaitable<void> serveStream(Peer peer, StreamHandshake handshake,
                                         const MeshStore& store, Metrics& metrics, AccessLog* log);

}  // namespace qtet
