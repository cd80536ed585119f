// The control frames that a session owes its client: pongs, pings, and one close frame at the end
// (RFC 6455, 5.5).
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "server/wire/web_socket_reader.h"

namespace qtet {

struct ControlFrame {
  std::uint8_t kind = 0;  ///< of WebSocketHeader
  std::string payload{};

  bool operator==(const ControlFrame&) const = default;
};

/// Nothing goes out behind the close frame.
class ControlFrames {
 public:
  /// Answers a ping. Only the last one that is not answered yet needs an answer.
  void pong(std::string payload) {
    assert(payload.size() <= 125);
    pong_ = std::move(payload);
  }
  void ping() { ping_ = true; }
  /// Closes by our own decision, unless a close frame is due or out already.
  /// `reason` is for people: UTF-8, at most 123 bytes (RFC 6455, 5.5).
  void close(CloseCode code, std::string_view reason = "") {
    assert(reason.size() <= 123);
    const auto number = static_cast<std::uint16_t>(code);
    if (closing()) return;
    ownCode_ = code;
    close_ = Due{std::string{static_cast<char>(number >> 8), static_cast<char>(number & 0xFF)} +
                 std::string(reason)};
  }
  /// That of a close frame by our own decision; nullopt: there is none.
  [[nodiscard]] std::optional<CloseCode> ownCode() const { return ownCode_; }
  /// Answers the client's close frame with the client's own code, as RFC 6455 suggests.
  void answerClose(std::string_view payload) {
    if (!closed()) close_ = Due{std::string(payload.substr(0, 2))};
  }

  /// A close frame is due or out: no other message may follow.
  [[nodiscard]] bool closing() const { return !std::holds_alternative<Open>(close_); }
  /// The close frame is out.
  [[nodiscard]] bool closed() const { return std::holds_alternative<Closed>(close_); }

  /// A pong or ping that is due; it may go before any message.
  [[nodiscard]] std::optional<ControlFrame> takeSign() {
    if (pong_) return ControlFrame{WebSocketHeader::kPong, *std::exchange(pong_, std::nullopt)};
    if (std::exchange(ping_, false)) return ControlFrame{WebSocketHeader::kPing};
    return std::nullopt;
  }
  /// The close frame, if it is due; it is out from then on.
  [[nodiscard]] std::optional<ControlFrame> takeClose() {
    auto* due = std::get_if<Due>(&close_);
    if (due == nullptr) return std::nullopt;
    ControlFrame out{WebSocketHeader::kClose, std::move(due->payload)};
    close_ = Closed();
    return out;
  }

 private:
  struct Open {};
  struct Due {
    std::string payload;
  };
  struct Closed {};

  std::optional<std::string> pong_;  ///< the payload of the last ping that is not answered
  bool ping_ = false;                ///< one is due
  std::optional<CloseCode> ownCode_;
  std::variant<Open, Due, Closed> close_;
};

}  // namespace qtet
