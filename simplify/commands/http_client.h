// As much of an HTTP/1.1 client as sending a log takes: one request a connection, over a plain
// socket.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// "http://HOST[:PORT]/PATH".
struct HttpUrl {
  std::string host;  ///< without the brackets of an IPv6 address
  std::string port = "80";
  std::string path;  ///< begins with /

  [[nodiscard]] std::string authority() const;
};

/// Errors: bad-value (https, which wants a proxy or a tunnel; user names; anything that is no such
/// URL).
[[nodiscard]] Result<HttpUrl> parseHttpUrl(const std::string& text);
/// Everything but RFC 3986's unreserved characters as %XX.
[[nodiscard]] std::string encodedSegment(const std::string& text);

struct HttpRequest {
  std::string method;
  std::string target;   ///< path and query
  std::string headers;  ///< whole lines, without Host and Content-Length
  ByteView body{};
  std::function<void(std::uint64_t sentBytes)> progress{};
  std::function<void()> waiting{};  ///< called once a second while all is sent and nothing has come
};

struct HttpAnswer {
  unsigned status = 0;
  std::string body;
};

/// Sends and reads the answer, at most kMaxAnswerBytes of it; each step has kStepTime, the answer
/// as a whole kAnswerTime. An answer that comes before the body was sent ends the sending. Errors:
/// io (no such host, refused, lost, too slow), bad-value (no HTTP).
[[nodiscard]] Result<HttpAnswer> exchange(const HttpUrl& server, const HttpRequest& request);

}  // namespace qtet
