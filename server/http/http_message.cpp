#include "server/http/http_message.h"

#include <cassert>
#include <utility>

#include "proto/json_reader.h"
#include "proto/sentence.h"
#include "server/wire/connection_limits.h"
#include "server/wire/http_date.h"

namespace qtet {

std::optional<std::uint64_t> Reply::bodyBytes() const {
  if (const auto* text = std::get_if<std::string>(&body)) return text->size();
  if (const auto* view = std::get_if<ByteView>(&body)) return view->size();
  return std::nullopt;
}

std::string_view Reply::header(std::string_view name) const {
  return headers.find(name).value_or("");
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

void appendHead(std::string& out, const Reply& reply, Afterwards afterwards) {
  assert(reply.status >= 200 && reply.status < 600 && reply.status != kClientGone);
  assert(!reply.file || std::holds_alternative<ByteView>(reply.body));
  out += "HTTP/1.1 ";
  out += std::to_string(reply.status);
  out += ' ';
  out += reasonPhrase(reply.status);
  out += "\r\nDate: ";
  out += httpDateNow();
  out += "\r\n";
  out += reply.headers.text();
  // RFC 9110, 8.6: none with 204; with 304 it would have to be that of the 200.
  const std::optional<std::uint64_t> bytes = reply.bodyBytes();
  if (bytes && reply.status != 204 && reply.status != 304) {
    out += "Content-Length: ";
    out += std::to_string(*bytes);
    out += "\r\n";
  }
  if (afterwards == Afterwards::kKept) out += "Connection: keep-alive\r\n";
  if (afterwards == Afterwards::kCloses) out += "Connection: close\r\n";
  out += "\r\n";
}

Reply momentaryReply(unsigned status, std::string_view type, std::string body) {
  Reply out;
  out.status = status;
  out.headers = {{"Cache-Control", "no-store"}};
  addType(out.headers, type);
  addCommonHeaders(out.headers);
  out.body = std::move(body);
  return out;
}

Reply problem(unsigned status, std::string_view type, std::string_view detail) {
  const Json json = {{"type", "/problems/" + std::string(type)},
                     {"title", reasonPhrase(status)},
                     {"status", status},
                     {"detail", sentence(detail)}};
  return momentaryReply(status, "application/problem+json", dumpJson(json));
}

Reply badRequestReply(std::string_view detail) { return problem(400, "bad-request", detail); }

Reply missingReply(std::string_view detail) { return problem(404, "not-found", detail); }

Reply busyReply(std::string_view detail) {
  Reply out = problem(503, "busy", detail);
  out.headers.add("Retry-After", std::to_string(limits::kRetryAfterSeconds));
  return out;
}

Reply noPlaceReply(std::string_view detail) {
  Reply out = busyReply(detail);
  out.refusal = Refusal::kPlaces;
  return out;
}

}  // namespace qtet
