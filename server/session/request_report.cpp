#include "server/session/request_report.h"

#include "server/routes/write_routes.h"
#include "server/wire/loggable.h"

namespace qtet {

namespace {

bool isChange(std::string_view method) {
  return method == "PUT" || method == "DELETE" || method == "POST";
}

std::string meshOf(std::string_view target) {
  const std::optional<RequestTarget> parts = parseTarget(target);
  return parts && isMeshPath(*parts) ? parts->segments[2] : "";
}

}  // namespace

void RequestReport::begin() {
  trace_ = log_ != nullptr ? traceOf(std::nullopt, std::nullopt) : RequestTrace();
  client_ = peer_;
  kind_ = {};
  method_.clear();
  target_.clear();
  change_.reset();
  received_ = 0;
  begun_ = std::chrono::steady_clock::now();
}

void RequestReport::identify(const RequestView& request) {
  kind_ = kindOf(request.method, request.target);
  if (log_ != nullptr || request.requestId || request.traceparent)
    trace_ = traceOf(request.requestId, request.traceparent);
  if (log_ == nullptr) return;
  method_ = request.method;
  const auto tokens = access_ != nullptr ? access_->tokens() : nullptr;
  const auto hidden = [&](std::string_view text) { return holdsSecret(text, tokens.get()); };
  target_ = loggableTarget(request.target, tokens.get());
  if (hidden(method_)) method_ = kWithheld;
  if (hidden(trace_.id) || hidden(trace_.traceId) || hidden(trace_.parentId))
    trace_ = traceOf(std::nullopt, std::nullopt);
  if (isChange(method_))
    change_ = {tokens ? tokens->nameOf(bearerDigest(request.authorization)) : "", meshOf(target_)};
}

void RequestReport::addHeaders(Reply& reply) const {
  if (!trace_.id.empty()) reply.headers.add("X-Request-Id", trace_.id);
  if (!trace_.traceId.empty()) reply.headers.add("traceparent", trace_.traceparent());
}

void RequestReport::end(unsigned status, std::uint64_t bytes, bool whole, Refusal refusal) const {
  const auto time = std::chrono::steady_clock::now() - begun_;
  metrics_.countRequest(kind_, status, bytes, time, refusal);
  if (log_ == nullptr) return;
  AccessEntry entry{client_, method_, target_, status, bytes, time, whole};
  if (change_) entry.change = &*change_;
  entry.received = received_;
  log_->write(entry, trace_);
}

}  // namespace qtet
