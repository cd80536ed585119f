#include "server/wire/metrics.h"

#include <algorithm>
#include <cstdio>

namespace qtet {
namespace {

std::string number(double value) {
  std::array<char, 32> out{};
  std::snprintf(out.data(), out.size(), "%.17g", value);
  return out.data();
}

std::string head(const std::string& name, const std::string& help, const char* type) {
  return "# HELP qtet_" + name + " " + help + "\n# TYPE qtet_" + name + " " + type + "\n";
}

}  // namespace

void Metrics::countRequest(unsigned status, std::uint64_t bytes, std::chrono::nanoseconds time) {
  byStatus_[std::min<std::size_t>(status, kStatuses - 1)].fetch_add(1, std::memory_order_relaxed);
  bytes_.fetch_add(bytes, std::memory_order_relaxed);
  nanoseconds_.fetch_add(static_cast<std::uint64_t>(time.count()), std::memory_order_relaxed);
  const double seconds = std::chrono::duration<double>(time).count();
  const auto bucket =
      static_cast<std::size_t>(std::ranges::lower_bound(kBounds, seconds) - kBounds.begin());
  byTime_[bucket].fetch_add(1, std::memory_order_relaxed);
}

std::string Metrics::text(const std::vector<Figure>& figures) const {
  std::string out = head("http_requests_total", "HTTP requests answered, by status.", "counter");
  for (std::size_t status = 0; status < kStatuses; ++status)
    if (const auto count = byStatus_[status].load(std::memory_order_relaxed); count > 0)
      out += "qtet_http_requests_total{code=\"" + std::to_string(status) + "\"} " +
             std::to_string(count) + "\n";

  out += head("http_request_duration_seconds",
              "From the end of a request's head to the end of its answer.", "histogram");
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < byTime_.size(); ++i) {
    sum += byTime_[i].load(std::memory_order_relaxed);
    out += "qtet_http_request_duration_seconds_bucket{le=\"" +
           (i < kBounds.size() ? number(kBounds[i]) : "+Inf") + "\"} " + std::to_string(sum) + "\n";
  }
  out += "qtet_http_request_duration_seconds_sum " +
         number(static_cast<double>(nanoseconds_.load()) * 1e-9) + "\n";
  out += "qtet_http_request_duration_seconds_count " + std::to_string(sum) + "\n";

  const auto counter = [&](const char* name, const char* help,
                           const std::atomic<std::uint64_t>& value) {
    out += head(name, help, "counter") + "qtet_" + name + " " +
           std::to_string(value.load(std::memory_order_relaxed)) + "\n";
  };
  counter("http_response_body_bytes_total",
          "Bytes of answers' bodies that were given to the network.", bytes_);
  counter("connections_total", "Connections that were let in.", connections_);
  counter("connections_refused_total",
          "Connections that were turned away: too many in all or from one address.", refused_);
  for (const Figure& figure : figures)
    out += head(figure.name, figure.help, figure.counter ? "counter" : "gauge") + "qtet_" +
           figure.name + " " + number(figure.value) + "\n";
  return out;
}

}  // namespace qtet
