#include "server/session/tls_greeting.h"

#include <cassert>
#include <chrono>
#include <optional>

#include "server/http/deadline.h"
#include "server/wire/handshakes.h"
#include "server/wire/turns.h"

namespace qtet {
namespace {

namespace asio = boost::asio;

/// The client's bytes stay in the kernel meanwhile. False: no place came free in the time for a
/// handshake, or the connection ends.
asio::awaitable<bool> waitForPlace(Peer& peer, Handshakes::Client& handshake,
                                   const Deadline& deadline) {
  while (const auto again = handshake.enter()) {
    std::optional<Deadline> retry;
    if (*again != Handshakes::Clock::time_point::max())
      retry.emplace(peer.socket, std::chrono::ceil<std::chrono::milliseconds>(
                                     *again - Handshakes::Clock::now()));
    const bool woken = co_await peer.socket.waitForCancel();
    if (!woken || deadline.passed() || peer.connection->ending()) co_return false;
  }
  co_return true;
}

}  // namespace

asio::awaitable<bool> shakeHandsInTurn(Peer& peer, const Services& services) {
  assert(peer.socket.isTls() && services.handshakes != nullptr);
  const Deadline deadline(peer.socket, services.timeouts.header);
  const IdleScope idle(peer);
  bool done = co_await peer.socket.announcesSoundHello();
  // Whoever holds a place may lose it. So nobody waits for a turn with one.
  if (done && owesTurn(peer.client.get())) {
    co_await takeTurn(peer.socket.get_executor(), peer.client.get());
    done = !peer.client->overdrawn() && !deadline.passed() && !peer.connection->ending();
  }
  Handshakes::Client handshake(
      *services.handshakes, peer.socket.get_executor(), [&peer] { peer.socket.cancel(); },
      peer.address());
  if (done) done = co_await waitForPlace(peer, handshake, deadline);
  if (done) done = co_await peer.socket.shakeHands(peer.client.get());
  if (!done) services.metrics.countFailedHandshake();
  co_return done;
}

}  // namespace qtet
