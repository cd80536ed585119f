// An end to waiting that leaves the socket open: Beast's own time-out closes it, and then nobody could be told.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <chrono>
#include <memory>

namespace qtet {

/// From its making on: after `time` what waits on the stream is cancelled. For the stream's executor alone; the stream must outlive it, and
/// have no time-out of its own (expires_never).
class Deadline {
 public:
  Deadline(boost::beast::tcp_stream& stream, std::chrono::milliseconds time)
      : timer_(stream.get_executor(), time), state_(std::make_shared<State>(State{&stream})) {
    timer_.async_wait([state = state_](const boost::system::error_code& cancelled) {
      if (cancelled || state->stream == nullptr) return;
      state->passed = true;
      state->stream->cancel();
    });
  }
  ~Deadline() { state_->stream = nullptr; }
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  [[nodiscard]] bool passed() const { return state_->passed; }

 private:
  struct State {
    boost::beast::tcp_stream* stream;
    bool passed = false;
  };
  boost::asio::steady_timer timer_;
  std::shared_ptr<State> state_;
};

}  // namespace qtet
