// A request and its answer as plain values, so that everything that decides can be tested without a
// socket.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "proto/bytes.h"
#include "server/wire/file_part.h"
#include "server/wire/header_lines.h"
#include "server/wire/refusal.h"

namespace qtet {

/// The parts of a request that the router looks at. The views belong to the request that was
/// parsed.
struct RequestView {
  std::string_view method;
  std::string_view target;
  std::optional<std::string_view> range = std::nullopt;
  std::optional<std::string_view> ifRange = std::nullopt;
  std::optional<std::string_view> ifMatch = std::nullopt;
  std::optional<std::string_view> ifNoneMatch = std::nullopt;
  std::optional<std::string_view> ifModifiedSince = std::nullopt;
  std::optional<std::string_view> ifUnmodifiedSince = std::nullopt;
  std::optional<std::string_view> acceptEncoding = std::nullopt;
  std::optional<std::string_view> authorization = std::nullopt;
  std::optional<std::string_view> expect = std::nullopt;
  std::optional<std::string_view> contentLength = std::nullopt;
  std::optional<std::string_view> contentRange = std::nullopt;
  std::optional<std::string_view> contentEncoding = std::nullopt;
  std::optional<std::string_view> requestId = std::nullopt;
  std::optional<std::string_view> traceparent = std::nullopt;
};

/// `body` is text that the reply owns, or bytes that live as long as `owner`. std::monostate leaves
/// it open: it does not exist yet, and its length is unknown.
struct Reply {
  unsigned status = 200;
  /// Without Content-Length, Date and Connection.
  HeaderLines headers;
  std::variant<std::string, ByteView, std::monostate> body;
  /// Owner of the body's bytes, unless they are the router's or the viewer's.
  std::shared_ptr<const void> owner{};
  /// The place of the body's bytes in an open file, if they are in one too.
  std::optional<FilePart> file{};
  bool sendBody = true;  ///< false for HEAD: the headers speak of the body that is left out
  bool close = false;    ///< the connection cannot be used any further
  Refusal refusal = Refusal::kNone;  ///< where the status does not say it

  /// The first header of that name, as it is written here; "" where there is none.
  [[nodiscard]] std::string_view header(std::string_view name) const;
  /// Bytes of the body; nullopt where it is left open.
  [[nodiscard]] std::optional<std::uint64_t> bodyBytes() const;
};

/// In figures and logs: the client left before its answer was made. nginx's number; never sent.
inline constexpr unsigned kClientGone = 499;

/// "Not Found" for 404.
[[nodiscard]] std::string_view reasonPhrase(unsigned status);

/// The connection's future once the answer is sent.
enum class Afterwards : std::uint8_t {
  kStays,  ///< as HTTP/1.1 has it, unless somebody says otherwise
  kKept,   ///< the same to a client of HTTP/1.0, which has to be told
  kCloses,
};

/// Appends the status line and the headers, with Content-Length, Date and Connection, and the empty
/// line.
void appendHead(std::string& out, const Reply& reply, Afterwards afterwards);

/// An answer that holds for this moment alone and is not to be kept.
[[nodiscard]] Reply momentaryReply(unsigned status, std::string_view type, std::string body);
/// An error as RFC 9457 has it; `type` is the last part of a path under /problems/.
[[nodiscard]] Reply problem(unsigned status, std::string_view type, std::string_view detail);

/// 400.
[[nodiscard]] Reply badRequestReply(std::string_view detail);
/// 404.
[[nodiscard]] Reply missingReply(std::string_view detail);

/// 503, to be asked for again in limits::kRetryAfterSeconds.
[[nodiscard]] Reply busyReply(std::string_view detail);
/// The same where all places are taken.
[[nodiscard]] Reply noPlaceReply(std::string_view detail);

}  // namespace qtet
