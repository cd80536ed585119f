// Identifies a request in the logs of several programs: an id of its own, and W3C Trace Context
// (traceparent).
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace qtet {

struct RequestTrace {
  std::string id;        ///< the client's X-Request-Id if it is a sound one, else a new one
  std::string traceId;   ///< 32 hexadecimal digits, or "" where no sound traceparent came
  std::string parentId;  ///< 16
  std::string spanId;    ///< 16: this request's own
  std::string flags;     ///< 2

  /// "00-TRACE-SPAN-FLAGS", what is sent back and what a next hop would get; "" without a trace.
  [[nodiscard]] std::string traceparent() const;
};

[[nodiscard]] RequestTrace traceOf(std::optional<std::string_view> requestId,
                                   std::optional<std::string_view> traceparent);

}  // namespace qtet
