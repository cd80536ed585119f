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

/// Figures of the process have the names that all programs give them.
std::string nameOf(const std::string& name) {
  return name.starts_with("process_") ? name : "qtet_" + name;
}

std::string head(const std::string& name, const std::string& help, const char* type) {
  return "# HELP " + nameOf(name) + " " + help + "\n# TYPE " + nameOf(name) + " " + type + "\n";
}

double secondsOf(const std::atomic<std::uint64_t>& nanoseconds) {
  return static_cast<double>(nanoseconds.load(std::memory_order_relaxed)) * 1e-9;
}

}  // namespace

void Metrics::Histogram::count(std::chrono::nanoseconds time) {
  nanoseconds_.fetch_add(static_cast<std::uint64_t>(time.count()), std::memory_order_relaxed);
  const double seconds = std::chrono::duration<double>(time).count();
  const auto bucket =
      static_cast<std::size_t>(std::ranges::lower_bound(kBounds, seconds) - kBounds.begin());
  byTime_[bucket].fetch_add(1, std::memory_order_relaxed);
}

std::string Metrics::Histogram::text(const std::string& name, const char* help) const {
  std::string out = head(name, help, "histogram");
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < byTime_.size(); ++i) {
    sum += byTime_[i].load(std::memory_order_relaxed);
    out += "qtet_" + name + "_bucket{le=\"" + (i < kBounds.size() ? number(kBounds[i]) : "+Inf") +
           "\"} " + std::to_string(sum) + "\n";
  }
  out += "qtet_" + name + "_sum " + number(secondsOf(nanoseconds_)) + "\n";
  out += "qtet_" + name + "_count " + std::to_string(sum) + "\n";
  return out;
}

void Metrics::countRequest(unsigned status, std::uint64_t bytes, std::chrono::nanoseconds time) {
  byStatus_[std::min<std::size_t>(status, kStatuses - 1)].fetch_add(1, std::memory_order_relaxed);
  bytes_.fetch_add(bytes, std::memory_order_relaxed);
  requests_.count(time);
}

std::string Metrics::text(const std::vector<Figure>& figures) const {
  std::string out = head("http_requests_total", "HTTP requests answered, by status.", "counter");
  for (std::size_t status = 0; status < kStatuses; ++status)
    if (const auto count = byStatus_[status].load(std::memory_order_relaxed); count > 0)
      out += "qtet_http_requests_total{code=\"" + std::to_string(status) + "\"} " +
             std::to_string(count) + "\n";
  out += requests_.text("http_request_duration_seconds",
                        "From the end of a request's head to the end of its answer.");
  out += firstFrames_.text("stream_first_frame_seconds",
                           "From a stream's open to the end of its first frame.");

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
  counter("streams_total", "WebSocket streams that were begun.", streams_);
  counter("stream_bytes_total", "Bytes of streams that the network took.", streamBytes_);
  counter("stream_credit_waits_total", "Times that a stream had more to send than its credit.",
          creditWaits_);
  std::vector<Figure> all = {
      {"streams_open", "WebSocket streams under way.", false,
       static_cast<double>(openStreams_.load(std::memory_order_relaxed))},
      {"stream_stalled_seconds_total", "Time that streams waited for the network.", true,
       secondsOf(stalled_)}};
  all.insert(all.end(), figures.begin(), figures.end());
  for (const Figure& figure : all)
    out += head(figure.name, figure.help, figure.counter ? "counter" : "gauge") +
           nameOf(figure.name) + " " + number(figure.value) + "\n";
  return out;
}

}  // namespace qtet
