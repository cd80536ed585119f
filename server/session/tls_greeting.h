// The TLS handshake of a connection, which waits for its turn and for a place.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/awaitable.hpp>

#include "server/session/services.h"
#include "server/wire/peer.h"

namespace qtet {

/// False: there is no TLS on the connection, because its time is over, it ends, or what came is no
/// sound handshake; that is counted. REQUIRES: a socket of TLS, and services with handshakes. Both
/// outlive the coroutine.
[[nodiscard]] boost::asio::awaitable<bool> shakeHandsInTurn(Peer& peer, const Services& services);

}  // namespace qtet
