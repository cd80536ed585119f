// Reads a WebSocket client's frames (RFC 6455, 5) from a stream of bytes cut anywhere. It gives
// messages, pings and closes, or the code to close with.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include "proto/bytes.h"

namespace qtet {

namespace limits {
/// Fragments of one message: nobody needs more than one for 64 KiB.
inline constexpr std::size_t kMaxFragments = 256;
}  // namespace limits

/// Close codes of RFC 6455, 7.4.1, that this server uses by its own decision.
enum class CloseCode : std::uint16_t {
  kGoingAway = 1001,
  kProtocol = 1002,
  kBadText = 1007,
  kPolicy = 1008,
  kTooBig = 1009,
  kInternal = 1011
};

/// Whether a close frame may carry it (RFC 6455, 7.4, and what IANA has registered since).
[[nodiscard]] bool isCloseCode(std::uint16_t code);

/// Holds at most one message and one read beyond it; nothing between messages.
class WebSocketReader {
 public:
  struct Event {
    enum class Kind : std::uint8_t { kText, kBinary, kPing, kPong, kClose };
    Kind kind = Kind::kText;
    /// A text in UTF-8, or the code and reason of a close as they arrived, both sound.
    std::string payload{};
  };

  /// REQUIRES: next() has said that more bytes are needed, or nothing was fed yet.
  void feed(std::string_view bytes) {
    assert(state_ == State::kHungry);
    state_ = State::kFed;
    buffer_.append(bytes);
  }
  /// The next thing that is whole; nullopt: more bytes are needed. REQUIRES: there was no error
  /// yet.
  [[nodiscard]] std::expected<std::optional<Event>, CloseCode> next();

 private:
  enum class Opcode : std::uint8_t {
    kContinuation = 0,
    kText = 1,
    kBinary = 2,
    kClose = 8,
    kPing = 9,
    kPong = 10
  };
  struct Frame {
    bool last = false;
    Opcode opcode = Opcode::kText;
    std::string payload;
  };
  enum class State : std::uint8_t { kHungry, kFed, kBroken };
  [[nodiscard]] std::expected<std::optional<Event>, CloseCode> takeEvent();
  [[nodiscard]] std::expected<std::optional<Frame>, CloseCode> takeFrame();
  [[nodiscard]] std::expected<std::optional<Event>, CloseCode> control(Frame frame) const;
  /// nullopt: the message continues in another frame.
  [[nodiscard]] std::expected<std::optional<Event>, CloseCode> data(Frame frame);

  State state_ = State::kHungry;
  std::string buffer_;
  std::string message_;         // fragments so far
  std::optional<Opcode> kind_;  // of the message whose fragments come
  std::size_t fragments_ = 0;
};

/// The header of an unmasked, unfragmented frame that a server sends; at most 10 bytes.
struct WebSocketHeader {
  std::uint8_t bytes[10];
  std::uint8_t size = 0;

  static constexpr std::uint8_t kText = 0x81, kBinary = 0x82, kClose = 0x88, kPing = 0x89,
                                kPong = 0x8A;
  WebSocketHeader(std::uint8_t kind, std::uint64_t payloadBytes);
};

/// The value of Sec-WebSocket-Accept for a key (RFC 6455, 4.2.2).
[[nodiscard]] std::string webSocketAccept(std::string_view key);
/// Whether it is what a client must send: 16 bytes in base64.
[[nodiscard]] bool isWebSocketKey(std::string_view key);

}  // namespace qtet
