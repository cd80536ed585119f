// Noticing that a client goes while its answer is being made.
#pragma once

#include <memory>
#include <utility>

#include "server/wire/client_socket.h"

namespace qtet {

/// Calls gone() once when the client has closed, even if only its sending half. If the client sends
/// its next request meanwhile, the watch stops: the end lies behind those bytes. Runs on the
/// socket's executor, until socket.cancel(). While pending() is true, somebody still waits, the
/// socket exists, and nobody else uses it.
template <class Pending, class Gone>
void watchForEnd(ClientSocket& socket, Pending pending, Gone gone) {
  socket.whenReadable([&socket, pending = std::move(pending),
                       gone = std::move(gone)](const boost::system::error_code& ec) mutable {
    if (!pending()) return;
    const Arrived arrived = ec ? Arrived::kEnd : socket.arrived();
    if (arrived == Arrived::kNothing)
      watchForEnd(socket, std::move(pending), std::move(gone));
    else if (arrived == Arrived::kEnd)
      gone();
  });
}

}  // namespace qtet
