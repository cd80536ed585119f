// A time limit for a wait that comes with every request.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <optional>

#include "server/wire/client_socket.h"

namespace qtet {

/// As Deadline, for one wait after the other. Its clock is set once in a while and not for each
/// wait, which would cost a system call each time. For the socket's executor alone; the socket must
/// outlive it.
class IdleTimer {
 public:
  using Clock = std::chrono::steady_clock;

  explicit IdleTimer(ClientSocket& socket)
      : state_(std::make_shared<State>(State{&socket, Timer(socket.get_executor())})) {}
  ~IdleTimer() {
    state_->socket = nullptr;
    state_->timer.cancel();
  }
  IdleTimer(const IdleTimer&) = delete;
  IdleTimer& operator=(const IdleTimer&) = delete;

  /// Cancels whatever waits on the socket after `time`, unless stop() comes before.
  void begin(std::chrono::milliseconds time) {
    state_->end = Clock::now() + time;
    if (!state_->armed || *state_->armed > *state_->end) arm(state_);
  }
  void stop() { state_->end.reset(); }

 private:
  using Timer = boost::asio::steady_timer;
  struct State {
    ClientSocket* socket;
    Timer timer;
    std::optional<Clock::time_point> end{};    ///< of the wait under way
    std::optional<Clock::time_point> armed{};  ///< when the timer fires, at `end` or before
  };

  static void arm(const std::shared_ptr<State>& state) {
    state->armed = state->end;
    state->timer.expires_at(*state->end);
    state->timer.async_wait([state](const boost::system::error_code& cancelled) {
      if (cancelled || state->socket == nullptr) return;
      state->armed.reset();
      if (!state->end) return;
      if (*state->end <= Clock::now())
        state->socket->cancel();
      else
        arm(state);
    });
  }

  std::shared_ptr<State> state_;
};

}  // namespace qtet
