#include "server/session/request_report.h"

#include <algorithm>

namespace qtet {

void RequestReport::begin() {
  trace_ = traceOf(std::nullopt, std::nullopt);
  client_ = peer_;
  method_.clear();
  target_.clear();
  begun_ = std::chrono::steady_clock::now();
}

void RequestReport::identify(const RequestView& request) {
  trace_ = traceOf(request.requestId, request.traceparent);
  method_ = request.method;
  target_ = request.target;
  // A ticket may still be good, wherever it was sent.
  if (const std::size_t query = target_.find('?');
      target_.find("ticket", std::min(query, target_.size())) != std::string::npos)
    target_.erase(query);
}

void RequestReport::addHeaders(Reply& reply) const {
  reply.headers.emplace_back("X-Request-Id", trace_.id);
  if (!trace_.traceId.empty()) reply.headers.emplace_back("traceparent", trace_.traceparent());
}

void RequestReport::end(unsigned status, std::uint64_t bytes, bool whole) const {
  const auto time = std::chrono::steady_clock::now() - begun_;
  metrics_.countRequest(status, bytes, time);
  if (log_ != nullptr) log_->write({client_, method_, target_, status, bytes, time, whole}, trace_);
}

}  // namespace qtet
