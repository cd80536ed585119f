#include "server/wire/metrics.h"

#ifndef NDEBUG
#include <spdlog/spdlog.h>
#endif

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>

#include "proto/version.h"

namespace qtet {
namespace {

/// The shortest decimal that is read as the same number, written as Prometheus' clients do: "0.005"
/// and not "0.0050000000000000001".
std::string number(double value) {
  constexpr double kMinFixed = 1e-4, kMaxFixed = 1e21;
  const double size = std::abs(value);
  const bool fixed = size == 0 || (size >= kMinFixed && size < kMaxFixed);
  std::array<char, 64> out{};
  const auto end = std::to_chars(out.data(), out.data() + out.size(), value,
                                 fixed ? std::chars_format::fixed : std::chars_format::scientific);
  return {out.data(), end.ptr};
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
  assert(time.count() >= 0);
  nanoseconds_.fetch_add(static_cast<std::uint64_t>(time.count()), std::memory_order_relaxed);
  const double seconds = std::chrono::duration<double>(time).count();
  const auto bucket =
      static_cast<std::size_t>(std::ranges::lower_bound(kBounds, seconds) - kBounds.begin());
  byTime_[bucket].fetch_add(1, std::memory_order_relaxed);
}

std::string Metrics::Histogram::text(const std::string& name, const std::string& labels) const {
  std::string out;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < byTime_.size(); ++i) {
    sum += byTime_[i].load(std::memory_order_relaxed);
    out += "qtet_" + name + "_bucket{" + labels + "le=\"" +
           (i < kBounds.size() ? number(kBounds[i]) : "+Inf") + "\"} " + std::to_string(sum) + "\n";
  }
  if (sum == 0 && !labels.empty()) return "";
  const std::string all =
      labels.empty() ? "" : "{" + labels.substr(0, labels.size() - 1) + "}";  // without the comma
  out += "qtet_" + name + "_sum" + all + " " + number(secondsOf(nanoseconds_)) + "\n";
  out += "qtet_" + name + "_count" + all + " " + std::to_string(sum) + "\n";
  return out;
}

void Metrics::countRequest(const RequestKind& kind, unsigned status, std::uint64_t bytes,
                           std::chrono::nanoseconds time, Refusal refusal) {
  assert(kind.method < kMethodLabels.size());
  byStatus_[std::min<std::size_t>(status, kStatuses - 1)].fetch_add(1, std::memory_order_relaxed);
  bytes_.fetch_add(bytes, std::memory_order_relaxed);
  if (kind.isUpload() && status >= 400) failedUploads_.fetch_add(1, std::memory_order_relaxed);
  if (refusal == Refusal::kNone) refusal = refusalBy(status);
  // The operators' own /readyz refuses nobody by its 503.
  if (refusal == Refusal::kBusy && kind.route == RouteLabel::kAdmin) refusal = Refusal::kNone;
  refusals_[static_cast<std::size_t>(refusal)].fetch_add(1, std::memory_order_relaxed);
  requests_[static_cast<std::size_t>(kind.route)][kind.method].count(time);
}

void Metrics::countLongTurn(std::string_view route, std::chrono::nanoseconds time) {
  longTurns_.fetch_add(1, std::memory_order_relaxed);
#ifndef NDEBUG
  spdlog::warn("{}: a turn of {:.1f} ms", route,
               std::chrono::duration<double, std::milli>(time).count());
#else
  (void)route, (void)time;
#endif
}

std::string Metrics::refusalText() const {
  std::string out = head("refusals_total", "Requests refused, by reason.", "counter");
  for (std::size_t i = 1; i < kRefusalLabels.size(); ++i)
    out += "qtet_refusals_total{reason=\"" + std::string(kRefusalLabels[i]) + "\"} " +
           std::to_string(refusals_[i].load(std::memory_order_relaxed)) + "\n";
  return out;
}

std::string Metrics::requestText() const {
  constexpr const char* kName = "http_request_duration_seconds";
  std::string out =
      head(kName, "From the end of a request's head to the end of its answer.", "histogram");
  for (std::size_t route = 0; route < kRouteLabels.size(); ++route)
    for (std::size_t method = 0; method < kMethodLabels.size(); ++method)
      out += requests_[route][method].text(kName, "route=\"" + std::string(kRouteLabels[route]) +
                                                      "\",method=\"" +
                                                      std::string(kMethodLabels[method]) + "\",");
  return out;
}

std::string Metrics::text(const std::vector<Figure>& figures) const {
  std::string out = head("build_info", "1; the label is the version of the server.", "gauge") +
                    "qtet_build_info{version=\"" + version() + "\"} 1\n";
  out += head("http_requests_total", "HTTP requests answered, by status.", "counter");
  for (std::size_t status = 0; status < kStatuses; ++status)
    if (const auto count = byStatus_[status].load(std::memory_order_relaxed); count > 0)
      out += "qtet_http_requests_total{code=\"" + std::to_string(status) + "\"} " +
             std::to_string(count) + "\n";
  out += requestText() + refusalText();
  out += head("stream_first_frame_seconds", "From a stream's open to the end of its first frame.",
              "histogram") +
         firstFrames_.text("stream_first_frame_seconds");

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
  counter("tls_handshakes_failed_total",
          "TLS handshakes that did not end well, also those without a place in time.",
          failedHandshakes_);
  counter("uploads_failed_total",
          "PUT of meshes with a status of 400 or more, or whose client left before the answer.",
          failedUploads_);
  counter("long_turns_total",
          "Pieces of work on a thread of connections that took more than 5 ms of the processor.",
          longTurns_);
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
  std::string_view last;
  for (const Figure& figure : all) {
    if (figure.name != last)
      out += head(figure.name, figure.help, figure.counter ? "counter" : "gauge");
    last = figure.name;
    out += nameOf(figure.name) + figure.labels + " " + number(figure.value) + "\n";
  }
  return out;
}

}  // namespace qtet
