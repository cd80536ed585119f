// Reports a stream to operators: the figures while it lasts, and a line of the access log at its
// end.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/wire/access_log.h"
#include "server/wire/metrics.h"
#include "server/wire/request_trace.h"

namespace qtet {

/// The request that became a stream.
struct StreamRequest {
  std::string client;  ///< address; "" where there is no log
  std::string target;
  RequestTrace trace;
};

/// Plain arithmetic on times: the owner looks at the clock. `metrics` and `log` outlive it.
class StreamReport {
 public:
  using Clock = std::chrono::steady_clock;

  /// The stream begins. `log` may be nullptr.
  StreamReport(Metrics& metrics, AccessLog* log, StreamRequest request, Clock::time_point now);
  /// Writes the line.
  ~StreamReport();
  StreamReport(const StreamReport&) = delete;
  StreamReport& operator=(const StreamReport&) = delete;

  /// An `open` was understood; its first frame is awaited from now on.
  void opened(std::string_view mesh, Clock::time_point now);
  /// The network took `bytes` bytes, heads of frames included.
  void took(std::size_t bytes);
  /// `frames` binary frames are written to their end.
  void wroteFrames(std::size_t frames, Clock::time_point now);
  /// There was something to write for so long, and the line had no room.
  void stalled(Clock::duration time);
  /// There is more to send and no credit for it. Counts once between two frames.
  void lacksCredit();
  /// Why it ends; the first reason stays. A literal.
  void ends(std::string_view why) {
    if (why_.empty()) why_ = why;
  }

 private:
  Metrics& metrics_;
  AccessLog* log_;
  StreamRequest request_;
  StreamEntry entry_;
  std::string mesh_;
  std::string_view why_;
  Clock::time_point begun_;
  std::optional<Clock::time_point> awaited_;  ///< since when a first frame is
  bool lacking_ = false;
};

}  // namespace qtet
