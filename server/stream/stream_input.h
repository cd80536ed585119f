// Passes on the input from a client of `/v1/stream`: messages to the protocol, pings and closes to
// the control frames.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string_view>

#include "server/stream/control_frames.h"
#include "server/stream/stream_protocol.h"
#include "server/wire/web_socket_reader.h"

namespace qtet {

/// Listens until the client has closed, or has said what ends the session; from then on it only
/// counts bytes. Both references outlive it.
class StreamInput {
 public:
  using Clock = std::chrono::steady_clock;
  StreamInput(StreamProtocol& protocol, ControlFrames& control)
      : protocol_(protocol), control_(control) {}

  /// Bytes as they come, cut anywhere.
  void take(std::string_view bytes, Clock::time_point now);
  [[nodiscard]] bool listens() const { return !ignored_; }
  /// Bytes that came after it had stopped to listen.
  [[nodiscard]] std::size_t ignoredBytes() const { return ignored_.value_or(0); }

 private:
  /// False: this was the last event that counts.
  bool handle(WebSocketReader::Event event, Clock::time_point now);
  bool countPing(Clock::time_point now);

  StreamProtocol& protocol_;
  ControlFrames& control_;
  WebSocketReader reader_;
  std::optional<std::size_t> ignored_;  ///< nullopt: it listens
  Clock::time_point second_{};          ///< when the window of `pings_` began
  unsigned pings_ = 0;
};

}  // namespace qtet
