// The client at the other end of a connection, and what its connection takes of the server's
// bounds.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <memory>

#include "server/wire/address_limits.h"
#include "server/wire/client_socket.h"
#include "server/wire/connections.h"

namespace qtet {

/// The places are given back when the object goes. For the socket's executor alone.
struct Peer {
  ClientSocket socket;
  std::shared_ptr<Connection> connection;         ///< its place among all; never nullptr
  std::unique_ptr<AddressLimits::Client> client;  ///< among its address's; nullptr: no bounds

  /// The same for all connections of one address; nullptr: it has no bounds.
  [[nodiscard]] const void* address() const { return client ? client->address() : nullptr; }
};

/// Around a wait that may be given up without loss: the server's end cancels it. The peer outlives
/// the object.
class IdleScope {
 public:
  explicit IdleScope(Peer& peer) : connection_(*peer.connection) {
    connection_.onEnd([&socket = peer.socket] { socket.cancel(); });
  }
  ~IdleScope() { connection_.onEnd({}); }
  IdleScope(const IdleScope&) = delete;
  IdleScope& operator=(const IdleScope&) = delete;

 private:
  Connection& connection_;
};

}  // namespace qtet
