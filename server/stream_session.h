// One WebSocket on `/v1/stream`: carries what StreamProtocol says, and keeps the socket alive and within bounds.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <memory>

#include "server/connections.h"
#include "server/mesh_store.h"

namespace qtet {

/// Answers the handshake `request`, which offers the subprotocol, and serves until the socket ends. Runs on the stream's executor, which
/// must be a single thread or a strand. REQUIRES: the stream has no time-out of its own (expires_never).
boost::asio::awaitable<void> serveStream(boost::beast::tcp_stream stream,
                                         boost::beast::http::request<boost::beast::http::empty_body> request, const MeshStore& store,
                                         std::shared_ptr<Connection> connection);

}  // namespace qtet
