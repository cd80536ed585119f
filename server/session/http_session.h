// One HTTP connection: reads requests, asks the router, writes answers, until one side has had
// enough or a WebSocket takes over.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/address.hpp>
#include <memory>
#include <optional>

#include "server/session/services.h"
#include "server/wire/peer.h"
#include "server/wire/tls_context.h"

namespace qtet {

/// Serves until the connection ends, over TLS where there is a context. `proxy` is the address of
/// the trusted proxy that has connected, if it is one: its clients are counted as it names them.
/// Runs on the socket's executor, which must be a single thread or a strand.
boost::asio::awaitable<void> serveHttp(boost::asio::ip::tcp::socket socket,
                                       std::shared_ptr<const TlsContext> tls,
                                       const Services& services,
                                       std::shared_ptr<Connection> connection,
                                       std::unique_ptr<AddressLimits::Client> client,
                                       std::optional<boost::asio::ip::address> proxy);

}  // namespace qtet
