// A parsed Beast request as the router's values, and what Beast's parser lets through though a
// proxy might read it differently.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/ip/address.hpp>
#include <boost/beast/http/message.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/http/http_message.h"
#include "server/wire/trusted_proxies.h"

namespace qtet {

using RequestHeader = boost::beast::http::request_header<>;

/// Joins the lines of lists into one, as RFC 9110, 5.3 reads them. Otherwise a look at a header
/// would find its first line only.
void joinLists(RequestHeader& header);

/// The views live as long as `header`. A `Range` that stands there twice is none, as one that makes
/// no sense is none.
[[nodiscard]] RequestView viewOf(const RequestHeader& header);

/// The client for whom the trusted proxy `sender` forwards, from all lines of the header that
/// `proxies` names. nullopt: there is no such header.
[[nodiscard]] std::optional<boost::asio::ip::address> forwardedClientOf(
    const RequestHeader& header, const TrustedProxies& proxies,
    const boost::asio::ip::address& sender);

/// The answer to a request that the server must not interpret. Reasons are no or several hosts, a
/// repeated header that may occur only once, an odd version, and a body where none is accepted.
/// Such an answer closes the connection, since the beginning of the next request is in doubt.
[[nodiscard]] std::optional<Reply> refusalOf(const RequestHeader& header);

/// Whether the request is a WebSocket handshake on the stream's path.
[[nodiscard]] bool isStreamHandshake(const RequestHeader& header);
/// 403 for a page whose origin is not among `origins`, unless that is nullptr or empty. A client
/// that names no origin is no browser, and other programs may name any origin. It closes the
/// connection.
[[nodiscard]] std::optional<Reply> originRefusal(const RequestHeader& header,
                                                 const std::vector<std::string>* origins);
/// GET, HEAD and OPTIONS.
[[nodiscard]] bool isReading(boost::beast::http::verb method);
/// The answer to a handshake that is not answered by 101: another version, no key, no subprotocol.
[[nodiscard]] std::optional<Reply> handshakeRefusal(const RequestHeader& header);

}  // namespace qtet
