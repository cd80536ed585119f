#include "server/session/preflight.h"

#include <algorithm>
#include <string_view>

namespace qtet {
namespace {

namespace http = boost::beast::http;

constexpr std::string_view kAllowOrigin = "Access-Control-Allow-Origin";
constexpr std::string_view kAllowMethods = "Access-Control-Allow-Methods";

/// "GET, HEAD, OPTIONS" of "GET, HEAD, OPTIONS, PUT, DELETE".
std::string readingOnly(std::string_view methods) {
  std::string out;
  for (const auto& method : http::token_list({methods.data(), methods.size()}))
    if (isReading(http::string_to_verb(method)))
      out += (out.empty() ? "" : ", ") + std::string(method.data(), method.size());
  return out;
}

}  // namespace

void answerForOrigin(Reply& reply, const RequestHeader& header,
                     const std::vector<std::string>* origins) {
  if (header.method() != http::verb::options || origins == nullptr || origins->empty()) return;
  // A browser or a proxy that keeps the answer must not take it for another page's.
  reply.headers.add("Vary", "Origin, Access-Control-Request-Method");
  const auto origin = header.find(http::field::origin);
  if (origin == header.end()) return;
  const bool stranger = originRefusal(header, origins).has_value();
  const auto asked = header[http::field::access_control_request_method];
  const bool changes = !asked.empty() && !isReading(http::string_to_verb(asked));
  if (!stranger)
    reply.headers.set(kAllowOrigin, {origin->value().data(), origin->value().size()});
  else if (changes)
    reply.headers.remove(kAllowOrigin);
  if (stranger && reply.headers.find(kAllowMethods))
    reply.headers.set(kAllowMethods, readingOnly(reply.header(kAllowMethods)));
}

}  // namespace qtet
