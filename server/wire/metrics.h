// The server's counters, and their text for Prometheus (exposition format 0.0.4).
#pragma once

#include <array>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/wire/refusal.h"
#include "server/wire/request_kind.h"

namespace qtet {

/// Thread-safe: figures are atomic and relaxed, since every figure stands for itself.
class Metrics {
 public:
  /// `refusal`: why it was refused, where the status does not say it.
  void countRequest(const RequestKind& kind, unsigned status, std::uint64_t bytes,
                    std::chrono::nanoseconds time, Refusal refusal = Refusal::kNone);
  void countFailedHandshake() { failedHandshakes_.fetch_add(1, std::memory_order_relaxed); }
  void countConnection() { connections_.fetch_add(1, std::memory_order_relaxed); }
  void countRefusedConnection() { refused_.fetch_add(1, std::memory_order_relaxed); }

  /// Work for a request of this route (kRouteLabels) held a thread of all clients for `time`.
  /// Logged in builds with assertions.
  void countLongTurn(std::string_view route, std::chrono::nanoseconds time);

  void beginStream() {
    streams_.fetch_add(1, std::memory_order_relaxed);
    openStreams_.fetch_add(1, std::memory_order_relaxed);
  }
  void endStream() {
    [[maybe_unused]] const auto before = openStreams_.fetch_sub(1, std::memory_order_relaxed);
    assert(before > 0);
  }
  void countStreamBytes(std::uint64_t bytes) {
    streamBytes_.fetch_add(bytes, std::memory_order_relaxed);
  }
  /// From an `open` to the end of its first frame.
  void countFirstFrame(std::chrono::nanoseconds time) { firstFrames_.count(time); }
  /// The network took nothing of a stream's bytes for so long.
  void countStreamStall(std::chrono::nanoseconds time) {
    stalled_.fetch_add(static_cast<std::uint64_t>(time.count()), std::memory_order_relaxed);
  }
  void countCreditWait() { creditWaits_.fetch_add(1, std::memory_order_relaxed); }

  /// A figure that somebody else keeps.
  struct Figure {
    const char* name;  ///< without "qtet_"; one that begins with "process_" stands as it is
    const char* help;
    bool counter = false;  ///< else a gauge
    double value = 0;
    const char* labels = "";  ///< `{cache="pages"}`; figures of one name follow each other
  };
  [[nodiscard]] std::string text(const std::vector<Figure>& figures) const;

 private:
  [[nodiscard]] std::string requestText() const;
  [[nodiscard]] std::string refusalText() const;

  static constexpr std::size_t kStatuses = 600;

  /// Times by their length.
  class Histogram {
   public:
    void count(std::chrono::nanoseconds time);
    /// Its series; `labels` stand in each, such as `route="log",`. "": nothing was counted.
    [[nodiscard]] std::string text(const std::string& name, const std::string& labels = "") const;

   private:
    /// Seconds; the last bucket has no bound.
    static constexpr std::array<double, 13> kBounds = {0.0005, 0.001, 0.005, 0.01, 0.05, 0.1, 0.5,
                                                       1,      5,     10,    60,   300,  600};
    std::array<std::atomic<std::uint64_t>, kBounds.size() + 1> byTime_{};
    std::atomic<std::uint64_t> nanoseconds_ = 0;
  };

  std::array<std::atomic<std::uint64_t>, kStatuses> byStatus_{};
  /// By route and method: 11 KB, whatever clients ask for.
  std::array<std::array<Histogram, kMethodLabels.size()>, kRouteLabels.size()> requests_;
  Histogram firstFrames_;
  /// By Refusal; the first one counts what was not refused.
  std::array<std::atomic<std::uint64_t>, kRefusalLabels.size()> refusals_{};
  std::atomic<std::uint64_t> bytes_ = 0, connections_ = 0, refused_ = 0, failedHandshakes_ = 0,
                             failedUploads_ = 0, longTurns_ = 0;
  std::atomic<std::uint64_t> streams_ = 0, openStreams_ = 0, streamBytes_ = 0, stalled_ = 0,
                             creditWaits_ = 0;
};

}  // namespace qtet
