#include "server/http/http_message.h"

#include <chrono>

#include "proto/json_reader.h"
#include "proto/sentence.h"
#include "server/http/http_conditions.h"
#include "server/wire/connection_limits.h"

namespace qtet {
namespace {

/// Headers that a page of another origin may read, besides the few that it always may.
constexpr const char* kExposedHeaders =
    "Accept-Ranges, Allow, Content-Disposition, Content-Encoding, Content-Location, Content-Range, "
    "ETag, Link, Location, "
    "Retry-After, traceparent, WWW-Authenticate, X-Request-Id";

}  // namespace

std::optional<std::uint64_t> Reply::bodyBytes() const {
  if (const auto* text = std::get_if<std::string>(&body)) return text->size();
  if (const auto* view = std::get_if<ByteView>(&body)) return view->size();
  return std::nullopt;
}

std::string Reply::header(std::string_view name) const {
  for (const auto& [key, value] : headers)
    if (key == name) return value;
  return "";
}

std::string_view reasonPhrase(unsigned status) {
  switch (status) {
    case 200: return "OK";
    case 201: return "Created";
    case 202: return "Accepted";
    case 204: return "No Content";
    case 206: return "Partial Content";
    case 304: return "Not Modified";
    case 307: return "Temporary Redirect";
    case 400: return "Bad Request";
    case 401: return "Unauthorized";
    case 403: return "Forbidden";
    case 404: return "Not Found";
    case 405: return "Method Not Allowed";
    case 408: return "Request Timeout";
    case 409: return "Conflict";
    case 411: return "Length Required";
    case 412: return "Precondition Failed";
    case 413: return "Content Too Large";
    case 415: return "Unsupported Media Type";
    case 416: return "Range Not Satisfiable";
    case 417: return "Expectation Failed";
    case 422: return "Unprocessable Content";
    case 426: return "Upgrade Required";
    case 429: return "Too Many Requests";
    case 431: return "Request Header Fields Too Large";
    case 500: return "Internal Server Error";
    case 501: return "Not Implemented";
    case 503: return "Service Unavailable";
    case 505: return "HTTP Version Not Supported";
    case 507: return "Insufficient Storage";
    default: return "Unknown";
  }
}

std::string headerText(const Reply& reply, bool keepAlive) {
  std::string out = "HTTP/1.1 " + std::to_string(reply.status) + " ";
  out += reasonPhrase(reply.status);
  out += "\r\nDate: " +
         httpDate(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())) + "\r\n";
  for (const auto& [name, value] : reply.headers) out += name + ": " + value + "\r\n";
  // RFC 9110, 8.6: none with 204; with 304 it would have to be that of the 200.
  const std::optional<std::uint64_t> bytes = reply.bodyBytes();
  if (bytes && reply.status != 204 && reply.status != 304)
    out += "Content-Length: " + std::to_string(*bytes) + "\r\n";
  out += keepAlive && !reply.close ? "Connection: keep-alive\r\n\r\n" : "Connection: close\r\n\r\n";
  return out;
}

Reply problem(unsigned status, std::string_view type, std::string_view detail) {
  const Json json = {{"type", "/problems/" + std::string(type)},
                     {"title", reasonPhrase(status)},
                     {"status", status},
                     {"detail", sentence(detail)}};
  Reply out;
  out.status = status;
  out.headers = {{"Content-Type", "application/problem+json"}, {"Cache-Control", "no-store"}};
  out.body = dumpJson(json);
  addCommonHeaders(out);
  return out;
}

Reply busyReply(std::string_view detail) {
  Reply out = problem(503, "busy", detail);
  out.headers.emplace_back("Retry-After", std::to_string(limits::kRetryAfterSeconds));
  return out;
}

Reply noPlaceReply(std::string_view detail) {
  Reply out = busyReply(detail);
  out.refusal = Refusal::kPlaces;
  return out;
}

void addCommonHeaders(Reply& reply) {
  // Logs are public and there are no cookies: any page may read them, also one that isolates itself
  // (COEP).
  reply.headers.insert(reply.headers.end(), {{"Server", "qtet-server/" QTET_VERSION},
                                             {"X-Content-Type-Options", "nosniff"},
                                             {"Access-Control-Allow-Origin", "*"},
                                             {"Access-Control-Expose-Headers", kExposedHeaders},
                                             {"Timing-Allow-Origin", "*"},
                                             {"Cross-Origin-Resource-Policy", "cross-origin"}});
}

}  // namespace qtet
