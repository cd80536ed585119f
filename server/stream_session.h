// One WebSocket on `/v1/stream`: carries what StreamProtocol says, and keeps the socket alive and within bounds.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>
#include <string>

#include "server/address_limits.h"
#include "server/connections.h"
#include "server/mesh_store.h"

namespace qtet {

/// A handshake that was found good.
struct StreamHandshake {
  std::string key;         ///< Sec-WebSocket-Key
  std::string firstBytes;  ///< what came behind its head already
};

/// Answers the handshake and serves until the socket ends. Runs on the socket's executor, which must be a single thread or a strand.
boost::asio::awaitable<void> serveStream(boost::asio::ip::tcp::socket socket, StreamHandshake handshake, const MeshStore& store,
                                         std::shared_ptr<Connection> connection, std::unique_ptr<AddressLimits::Visitor> visitor);

}  // namespace qtet
