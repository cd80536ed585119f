// One HTTP connection: reads requests, asks the router, writes answers, until one side has had
// enough or a WebSocket takes over.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <memory>

#include "server/session/services.h"
#include "server/wire/peer.h"
#include "server/wire/tls_context.h"

namespace qtet {

/// Serves until the connection ends, over TLS where there is a context. With `ofProxy` it is that
/// of a trusted proxy, whose clients are counted as it names them. Runs on the socket's
/// executor, which must be a single thread or a strand.
boost::asio::awaitable<void> serveHttp(boost::asio::ip::tcp::socket socket,
                                       std::shared_ptr<const TlsContext> tls,
                                       const Services& services,
                                       std::shared_ptr<Connection> connection,
                                       std::unique_ptr<AddressLimits::Client> client, bool ofProxy);

}  // namespace qtet
