// Requests over HTTP and HTTPS through libcurl, one a connection.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// "http[s]://HOST[:PORT]/PATH".
struct HttpUrl {
  std::string origin;  ///< scheme, host and port, without a slash at the end
  std::string path;    ///< begins with /
};

/// Errors: bad-value (another scheme, a user's name, a query, anything that is no such URL).
[[nodiscard]] Result<HttpUrl> parseHttpUrl(const std::string& text);
/// Everything but RFC 3986's unreserved characters as %XX.
[[nodiscard]] std::string encodedSegment(const std::string& text);

/// The time for the name, TCP and the handshake of TLS together: a lost packet is sent again after
/// 1, 3, 7 and 15 s.
inline constexpr std::chrono::seconds kConnectTime{30};
/// The time without a byte either way: longer than a mobile network's gaps.
inline constexpr std::chrono::seconds kStallTime{30};

/// How long an exchange waits before it gives up.
struct HttpPatience {
  std::chrono::milliseconds connecting = kConnectTime;
  /// The time for the next piece of the body to be taken.
  std::chrono::milliseconds moving = kStallTime;
  /// The time for the next bytes of the answer, after the whole request was sent.
  std::chrono::milliseconds answering = kStallTime;
};

struct HttpRequest {
  std::string method;  ///< GET or PUT
  std::string target;  ///< path and query
  /// "Name: value". Authorization is never sent to another scheme, host or port.
  std::vector<std::string> headers{};
  ByteView body{};
  std::string authorities{};  ///< a PEM file, trusted instead of the system's; empty: the system's
  HttpPatience patience{};
  std::function<void(std::uint64_t sentBytes)> progress{};
  std::function<void()> waiting{};  ///< called about once a second while all is sent
};

struct HttpAnswer {
  unsigned status = 0;
  std::string body;
  std::string location;  ///< the target of a redirection that was not followed; else empty
  std::string etag{};    ///< as it stands in the header; empty: there is none
};

/// Sends and reads the answer, at most kMaxAnswerBytes of it. Certificates are checked, TLS is 1.2
/// or later, and only a GET follows redirections. An answer of 400 or more before the body was sent
/// ends the sending. A proxy of the environment is used for https alone. Errors: io (no such host,
/// refused, lost, too slow), bad-value (no HTTP, a certificate that does not hold), not-found (the
/// file of the authorities).
[[nodiscard]] Result<HttpAnswer> exchange(const HttpUrl& server, const HttpRequest& request);

}  // namespace qtet
