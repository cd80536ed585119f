// Decodes for strangers in processes of their own. The death of one is an error of the task that it
// had.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "server/store/level_file.h"
#include "server/store/level_request.h"
#include "server/store/log_check.h"

namespace qtet {

namespace limits {
/// Processor time of one level: as much as the check of the largest log.
inline constexpr std::chrono::seconds kLevelTime{600};
/// Private memory of a process that has decoded nothing yet, and a margin.
inline constexpr std::uint64_t kDecoderBaseBytes = 128u << 20;
}  // namespace limits

struct DecoderOptions {
  std::size_t processes = 1;               ///< tasks at a time; others wait
  std::uint64_t levelBytes = 0;            ///< memory of one level
  std::string program = "/proc/self/exe";  ///< qtet-server
};

struct DecoderCounts {
  std::uint64_t lost = 0;   ///< processes that ended by themselves, since the start
  std::size_t running = 0;  ///< tasks under way
};

/// Thread-safe: a mutex guards the places, and a taken place is its task's alone.
class Decoders {
 public:
  /// Starts the processes, so that none has to be waited for later.
  explicit Decoders(DecoderOptions options);
  /// REQUIRES: no task is under way.
  ~Decoders();
  Decoders(const Decoders&) = delete;
  Decoders& operator=(const Decoders&) = delete;

  /// Makes the level in the process that had its log last, if that one is idle. Errors: those of
  /// makeLevel; io (the process ended, or none can be started), cancelled. After `stop` the result
  /// is useless.
  [[nodiscard]] Result<LevelFile> level(const LevelRequest& request, const std::stop_token& stop);
  /// The check of a log. It is kFailed if the process ended.
  [[nodiscard]] CheckVerdict check(const ServedMesh& mesh, const CheckLimits& limits,
                                   const std::stop_token& stop);
  [[nodiscard]] DecoderCounts counts() const;
  /// Those of the processes that are there. REQUIRES: no task is under way.
  [[nodiscard]] std::vector<pid_t> processes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace qtet
