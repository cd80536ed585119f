// The words of `/v1/stream` (STREAM.md): JSON messages both ways and the header of a
// binary frame. Parsers trust nothing; every count and length is compared with a limit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"
#include "proto/stream_request.h"
#include "proto/target.h"

namespace qtet {

/// The subprotocol that a client must offer in Sec-WebSocket-Protocol.
inline constexpr std::string_view kStreamSubprotocol = "qtet.v1";
/// Bytes of one JSON message: an `open` that names kMaxRequestFields fields twice, in names of
/// ordinary length, needs under half of it.
inline constexpr std::size_t kMaxMessageBytes = 64u << 10;
/// Bytes of credit that one message can grant: the largest integer that JSON keeps exactly in every
/// language (2^53 - 1).
inline constexpr std::uint64_t kMaxCredit = (std::uint64_t{1} << 53) - 1;

// ---- client to server

struct OpenMessage {
  std::string mesh;
  std::string digest;               ///< empty: any
  std::vector<std::string> fields;  ///< to send, in any order
  std::optional<StreamTime> time;   ///< nullopt: no name means a series
  Have have;
  Target target;
  std::uint64_t credit = 0;  ///< bytes
};
struct CreditMessage {
  std::uint64_t bytes = 0;
};
struct TargetMessage {
  Target target;
};
struct PauseMessage {};
struct ResumeMessage {
  std::optional<Have> have;  ///< nullopt: as the server knows it
};
/// `cancel`, or `stop`, its older name.
struct CancelMessage {};
using ClientMessage = std::variant<OpenMessage, CreditMessage, TargetMessage, PauseMessage,
                                   ResumeMessage, CancelMessage>;

/// Errors: limit-exceeded (above kMaxMessageBytes), bad-value with the JSON pointer of what is
/// wrong. Unknown members are ignored.
[[nodiscard]] Result<ClientMessage> parseClientMessage(std::string_view json);
[[nodiscard]] std::string toJson(const ClientMessage& message);

// ---- server to client

struct OpenedMessage {
  std::uint32_t stream = 0;
  std::string mesh;
  std::string digest;
  std::uint64_t bytes = 0;    ///< of the whole log
  std::uint64_t planned = 0;  ///< payload bytes that will follow
};
/// Answers `target`.
struct PlannedMessage {
  std::uint32_t stream = 0;
  std::uint64_t planned = 0;  ///< payload bytes that will follow
};
struct DoneMessage {
  std::uint32_t stream = 0;
};
struct StoppedMessage {
  std::uint32_t stream = 0;
};
/// Codes of `error` messages.
inline constexpr const char* kBadMessage = "bad-message";
inline constexpr const char* kNotFound = "not-found";
inline constexpr const char* kUnknownField = "unknown-field";
inline constexpr const char* kLogChanged = "log-changed";
inline constexpr const char* kTooManyMessages = "too-many-messages";
struct ErrorMessage {
  std::string code;
  std::string detail;
};
using ServerMessage =
    std::variant<OpenedMessage, PlannedMessage, DoneMessage, StoppedMessage, ErrorMessage>;

/// Errors: as parseClientMessage.
[[nodiscard]] Result<ServerMessage> parseServerMessage(std::string_view json);
[[nodiscard]] std::string toJson(const ServerMessage& message);

// ---- binary frames

/// The 16 bytes before a frame's payload.
struct FrameHeader {
  static constexpr std::size_t kBytes = 16;
  /// `firstPart` of the frame that carries header, manifest and chunk table; its `chunk` and
  /// `parts` are 0.
  static constexpr std::uint16_t kHead = 0xFFFF;
  /// `parts` of a frame that carries some bytes of the block `firstPart`, but not its last.
  static constexpr std::uint16_t kPiece = 0;

  std::uint32_t stream = 0;
  std::uint32_t chunk = 0;
  std::uint16_t firstPart = 0;
  std::uint16_t parts = 0;
  std::uint32_t size = 0;  ///< payload bytes

  [[nodiscard]] std::array<std::uint8_t, kBytes> encode() const;
  /// Reads a whole frame. Errors: truncated (under 16 bytes), bad-value (the payload is not `size`
  /// bytes long, or a head that names a chunk or parts, or a piece without bytes).
  [[nodiscard]] static Result<FrameHeader> parse(ByteView frame);
  bool operator==(const FrameHeader&) const = default;
};

}  // namespace qtet
