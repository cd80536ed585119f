// A time limit for waiting that leaves the socket open, so that the client can get an answer.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>

#include "server/wire/client_socket.h"

namespace qtet {

/// Cancels whatever waits on the socket, `time` after construction. For the socket's executor
/// alone; the socket must outlive it.
class Deadline {
 public:
  Deadline(ClientSocket& socket, std::chrono::milliseconds time)
      : timer_(socket.get_executor(), time), state_(std::make_shared<State>(State{&socket})) {
    timer_.async_wait([state = state_](const boost::system::error_code& cancelled) {
      if (cancelled || state->socket == nullptr) return;
      state->passed = true;
      state->socket->cancel();
    });
  }
  ~Deadline() { state_->socket = nullptr; }
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  [[nodiscard]] bool passed() const { return state_->passed; }

 private:
  struct State {
    ClientSocket* socket;
    bool passed = false;
  };
  boost::asio::steady_timer timer_;
  std::shared_ptr<State> state_;
};

}  // namespace qtet
