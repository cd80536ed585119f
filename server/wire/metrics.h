// What the server counts, and its text for Prometheus (exposition format 0.0.4).
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace qtet {

/// Thread-safe; relaxed, since every figure stands for itself.
class Metrics {
 public:
  void countRequest(unsigned status, std::uint64_t bytes, std::chrono::nanoseconds time);
  void countConnection() { connections_.fetch_add(1, std::memory_order_relaxed); }
  void countRefusedConnection() { refused_.fetch_add(1, std::memory_order_relaxed); }

  /// A figure that somebody else keeps.
  struct Figure {
    const char* name;  ///< without "qtet_"
    const char* help;
    bool counter = false;  ///< else a gauge
    double value = 0;
  };
  [[nodiscard]] std::string text(const std::vector<Figure>& figures) const;

 private:
  /// Seconds; the last bucket has no bound.
  static constexpr std::array<double, 9> kBounds = {0.0005, 0.001, 0.005, 0.01, 0.05,
                                                    0.1,    0.5,   1,     10};
  static constexpr std::size_t kStatuses = 600;

  std::array<std::atomic<std::uint64_t>, kStatuses> byStatus_{};
  std::array<std::atomic<std::uint64_t>, kBounds.size() + 1> byTime_{};
  std::atomic<std::uint64_t> bytes_ = 0, nanoseconds_ = 0, connections_ = 0, refused_ = 0;
};

}  // namespace qtet
