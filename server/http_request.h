// A parsed Beast request as the router's values, and what Beast's parser lets through though a proxy might read it differently.
#pragma once

#include <boost/beast/http/message.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/http_message.h"

namespace qtet {

using RequestHeader = boost::beast::http::request_header<>;

/// The views live as long as `header`.
[[nodiscard]] RequestView viewOf(const RequestHeader& header);

/// The answer to a request that must not be understood: no or several hosts, an odd version, a body (nothing here takes one).
/// Such an answer closes the connection, since where the next request would begin is in doubt.
[[nodiscard]] std::optional<Reply> refusalOf(const RequestHeader& header);

/// Whether the request is a WebSocket handshake on the stream's path.
[[nodiscard]] bool isStreamHandshake(const RequestHeader& header);
/// The answer to a handshake that is not answered by 101: another version, no key, no subprotocol, or of a page whose origin is not among `origins`
/// (unless that is nullptr or empty; whoever names no origin is no browser, and whoever is none may name any).
[[nodiscard]] std::optional<Reply> handshakeRefusal(const RequestHeader& header, const std::vector<std::string>* origins);

}  // namespace qtet
