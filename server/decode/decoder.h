// A process of the server's own program that decodes one log at a time, seen from the server.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>

#include "server/decode/channel.h"
#include "server/decode/decode_task.h"

namespace qtet {

namespace limits {
/// From a stop to the end of a process that does not heed it: far above the time of one chunk.
inline constexpr std::chrono::seconds kDecoderStopTime{2};
/// A message on its way: far above what a machine that is busy with other things makes of it.
inline constexpr std::chrono::seconds kDecoderMessageTime{10};
/// Open files: the channel, standard error, two of a task, and room.
inline constexpr std::uint64_t kDecoderFiles = 16;
}  // namespace limits

/// Bounds on one task. The system keeps them, whatever the process does.
struct TaskLimits {
  std::uint64_t memoryBytes = 0;  ///< private memory, with what the program itself takes
  std::uint64_t fileBytes = 0;    ///< of the level
  std::chrono::seconds time{0};   ///< of the processor
};

/// One thread at a time.
class Decoder {
 public:
  /// Starts the process from `program`, qtet-server's own file. Errors: io.
  [[nodiscard]] static Result<std::unique_ptr<Decoder>> start(const std::string& program);
  /// Ends it.
  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  /// Sends the task and waits for its answer. Errors: io (the process has ended, and the object is
  /// of no use any more; the message says how), cancelled (`stop`, likewise, where the process did
  /// not heed it).
  [[nodiscard]] Result<DecodeAnswer> ask(const DecodeTask& task, std::span<const int> files,
                                         const TaskLimits& bounds, const std::stop_token& stop);
  /// Whether the process is there. It may end at any moment.
  [[nodiscard]] bool alive() const;
  /// The system filters the process's calls. Known after the first answer.
  [[nodiscard]] bool confined() const { return confined_; }
  [[nodiscard]] pid_t process() const { return process_; }

 private:
  Decoder(Channel channel, pid_t process);
  [[nodiscard]] Result<DecodeAnswer> next(const std::stop_token& stop);
  /// The process is gone, or is killed; the error says how it ended.
  std::unexpected<Error> lost();
  void bound(const TaskLimits& bounds) const;

  Channel channel_;
  pid_t process_;
  Descriptor wake_;  // readable once a stop was requested
  bool ready_ = false, confined_ = false;
};

}  // namespace qtet
