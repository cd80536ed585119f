#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/session/http_request.h"

#include <algorithm>
#include <array>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <iterator>

#include "proto/messages.h"
#include "server/routes/http_router.h"
#include "server/wire/web_socket_reader.h"

namespace qtet {
namespace {

namespace http = boost::beast::http;

std::string_view toView(boost::beast::string_view text) { return {text.data(), text.size()}; }

template <class Name>
std::optional<std::string_view> headerValue(const RequestHeader& header, const Name& name) {
  const auto it = header.find(name);
  if (it == header.end()) return std::nullopt;
  return toView(it->value());
}

/// A host, perhaps with a port: enough to refuse what cannot be one.
bool plausibleHost(std::string_view host) {
  constexpr std::string_view kForbidden = " \t\"#%/<>?@\\^`{|}";
  return std::ranges::all_of(host, [&](char c) {
    return c > ' ' && c < 0x7F && kForbidden.find(c) == std::string_view::npos;
  });
}

Reply closing(unsigned status, std::string_view type, std::string_view detail) {
  Reply out = problem(status, type, detail);
  out.close = true;
  return out;
}

/// Headers that may occur only once. If one occurs twice, a proxy may use the other line than we
/// do. It could then let through another token, another part of a log, or the answer to another
/// question.
constexpr std::array kSingles = {http::field::authorization,
                                 http::field::content_range,
                                 http::field::if_range,
                                 http::field::if_modified_since,
                                 http::field::if_unmodified_since,
                                 http::field::sec_websocket_version,
                                 http::field::origin};
constexpr std::array kLists = {http::field::if_match,         http::field::if_none_match,
                               http::field::accept_encoding,  http::field::expect,
                               http::field::content_encoding, http::field::upgrade,
                               http::field::connection,       http::field::sec_websocket_protocol};

/// A list of `100-continue`, mostly of one.
bool understood(std::string_view expectations) {
  for (const auto& expectation : http::token_list({expectations.data(), expectations.size()}))
    if (!boost::beast::iequals(expectation, "100-continue")) return false;
  const auto equals = expectations.find_first_of("=;\"");
  return equals == std::string_view::npos && !expectations.empty();
}

std::optional<Reply> bodyRefusal(const RequestHeader& header) {
  const std::size_t lengths = header.count(http::field::content_length);
  if (header.count(http::field::transfer_encoding) > 0) {
    if (lengths > 0 || header.version() == 10)
      return closing(400, "bad-request",
                     "Transfer-Encoding is beside Content-Length or in HTTP/1.0");
    return closing(501, "not-implemented",
                   "this server takes request bodies with a Content-Length only");
  }
  if (lengths == 0) return std::nullopt;
  const std::string_view length = *headerValue(header, http::field::content_length);
  if (lengths > 1 || length.empty() ||
      length.find_first_not_of("0123456789") != std::string_view::npos)
    return closing(400, "bad-request", "Content-Length must be one number");
  if (length.find_first_not_of('0') != std::string_view::npos && header.method() != http::verb::put)
    return closing(413, "content-too-large", "only PUT has a body here");
  return std::nullopt;
}

}  // namespace

void joinLists(RequestHeader& header) {
  for (const http::field name : kLists) {
    const auto [first, last] = header.equal_range(name);
    if (first == last || std::next(first) == last) continue;
    std::string all;
    for (auto line = first; line != last; ++line)
      all += (all.empty() ? "" : ", ") + std::string(toView(line->value()));
    header.set(name, all);
  }
}

RequestView viewOf(const RequestHeader& header) {
  return {
      .method = toView(header.method_string()),
      .target = toView(header.target()),
      .range = header.count(http::field::range) == 1 ? headerValue(header, http::field::range)
                                                     : std::nullopt,
      .ifRange = headerValue(header, http::field::if_range),
      .ifMatch = headerValue(header, http::field::if_match),
      .ifNoneMatch = headerValue(header, http::field::if_none_match),
      .ifModifiedSince = headerValue(header, http::field::if_modified_since),
      .ifUnmodifiedSince = headerValue(header, http::field::if_unmodified_since),
      .acceptEncoding = headerValue(header, http::field::accept_encoding),
      .authorization = headerValue(header, http::field::authorization),
      // RFC 9110, 10.1.1: HTTP/1.0 knows none
      .expect = header.version() == 11 ? headerValue(header, http::field::expect) : std::nullopt,
      .contentLength = headerValue(header, http::field::content_length),
      .contentRange = headerValue(header, http::field::content_range),
      .contentEncoding = headerValue(header, http::field::content_encoding),
      .requestId = headerValue(header, "X-Request-Id"),
      .traceparent = headerValue(header, "traceparent")};
}

std::optional<boost::asio::ip::address> forwardedClientOf(const RequestHeader& header,
                                                          const TrustedProxies& proxies,
                                                          const boost::asio::ip::address& sender) {
  const char* name = proxies.header == ProxyHeader::kForwarded ? "Forwarded" : "X-Forwarded-For";
  const auto [first, end] = header.equal_range(name);
  if (first == end) return std::nullopt;
  std::string list(toView(first->value()));
  for (auto line = std::next(first); line != end; ++line) {
    list += ',';
    list += toView(line->value());
  }
  return forwardedClient(proxies, sender, list);
}

std::optional<Reply> refusalOf(const RequestHeader& header) {
  if (header.version() != 11 && header.version() != 10)
    return closing(505, "version-not-supported", "this server speaks HTTP/1.1 and HTTP/1.0");
  const std::size_t hosts = header.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && header.version() == 11))
    return closing(400, "bad-request", "there must be one Host header");
  if (hosts == 1 && !plausibleHost(*headerValue(header, http::field::host)))
    return closing(400, "bad-request", "the Host header is no host");
  for (const http::field name : kSingles)
    if (header.count(name) > 1)
      return closing(400, "bad-request",
                     std::string(toView(http::to_string(name))) + " may be there once");
  const auto expect = headerValue(header, http::field::expect);
  if (expect && header.version() == 11 && !understood(*expect))
    return closing(417, "expectation-failed",
                   "the only expectation that is understood is 100-continue");
  return bodyRefusal(header);
}

bool isStreamHandshake(const RequestHeader& header) {
  const std::string_view target = toView(header.target());
  // HTTP/1.0 knows no Upgrade (RFC 9110, 7.8).
  if (target.substr(0, target.find('?')) != kStreamPath || header.method() != http::verb::get ||
      header.version() != 11)
    return false;
  return http::token_list{header[http::field::upgrade]}.exists("websocket") &&
         http::token_list{header[http::field::connection]}.exists("upgrade");
}

std::optional<Reply> originRefusal(const RequestHeader& header,
                                   const std::vector<std::string>* origins) {
  const auto origin = headerValue(header, http::field::origin);
  if (origins == nullptr || origins->empty() || !origin ||
      std::ranges::find(*origins, *origin) != origins->end())
    return std::nullopt;
  return closing(
      403, "forbidden",
      "pages of this origin may not open streams, ask for tickets or change meshes here");
}

bool isReading(http::verb method) {
  return method == http::verb::get || method == http::verb::head || method == http::verb::options;
}

std::optional<Reply> handshakeRefusal(const RequestHeader& header) {
  if (header[http::field::sec_websocket_version] != "13") {
    Reply out =
        closing(426, "upgrade-required", "this server speaks version 13 of the WebSocket protocol");
    out.headers.add("Sec-WebSocket-Version", "13");
    return out;
  }
  if (header.count(http::field::sec_websocket_key) != 1 ||
      !isWebSocketKey(toView(header[http::field::sec_websocket_key])))
    return closing(400, "bad-request", "Sec-WebSocket-Key must be 16 bytes in base64");
  http::token_list offered{header[http::field::sec_websocket_protocol]};
  if (offered.exists({kStreamSubprotocol.data(), kStreamSubprotocol.size()})) return std::nullopt;
  return closing(400, "bad-request", "offer the subprotocol " + std::string(kStreamSubprotocol));
}

}  // namespace qtet
