// Records the current request in the figures and in the access log.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/http_message.h"
#include "server/stream/stream_report.h"
#include "server/wire/access.h"
#include "server/wire/access_log.h"
#include "server/wire/metrics.h"
#include "server/wire/request_trace.h"

namespace qtet {

/// Reports on one connection, request by request. `metrics` and `log` outlive it.
class RequestReport {
 public:
  /// `address` is the client's, "" where there is no log. Its first request begins.
  /// `access` judges tokens; nullptr: there are none.
  RequestReport(Metrics& metrics, AccessLog* log, const Access* access, std::string address)
      : metrics_(metrics), log_(log), access_(access), peer_(std::move(address)) {
    begin();
  }

  /// The peer is a proxy, and the client another: for the whole connection, or for this request.
  void setPeer(std::string address) { client_ = peer_ = std::move(address); }
  void setClient(std::string address) { client_ = std::move(address); }
  /// A request of which nothing is known yet.
  void begin();
  /// Its head has come.
  void identify(const RequestView& request);
  /// Its label, once its head has come.
  [[nodiscard]] std::string_view route() const {
    return kRouteLabels[static_cast<std::size_t>(kind_.route)];
  }
  /// Bytes of the request's body that have come.
  void received(std::uint64_t bytes) { received_ += bytes; }
  /// X-Request-Id if the client has sent one or the access log has a line of that id; traceparent
  /// if the client has sent one.
  void addHeaders(Reply& reply) const;
  /// The request's data for the report of the stream that it becomes.
  [[nodiscard]] StreamRequest streamRequest() const { return {client_, target_, trace_}; }
  /// Its answer was sent, or nobody waits for it any more. `bytes` of the body went out. `refusal`
  /// says more than the status.
  void end(unsigned status, std::uint64_t bytes, bool whole,
           Refusal refusal = Refusal::kNone) const;

 private:
  Metrics& metrics_;
  AccessLog* log_;
  const Access* access_;
  std::string peer_, client_;
  RequestTrace trace_;
  RequestKind kind_;
  std::string method_, target_;
  std::optional<ChangeEntry> change_;  // the request changes something
  std::uint64_t received_ = 0;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace qtet
