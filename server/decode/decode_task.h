// The messages of the server and a process that decodes for it. Both are the same program, so the
// format has no version.
#pragma once

#include <variant>

#include "server/store/level_request.h"
#include "server/store/log_check.h"

namespace qtet {

/// A level to be written into the second of the message's files; the first is the log.
/// Its `mesh` is nullptr on the way.
struct LevelTask {
  std::string digest{};  ///< of the log
  LevelRequest request{};
};
/// A log to be checked, the message's only file.
struct CheckTask {
  CheckLimits limits{};
};
/// Nobody waits for the task under way any more.
struct StopTask {};
using DecodeTask = std::variant<LevelTask, CheckTask, StopTask>;

/// The process can take tasks.
struct DecoderReady {
  bool confined = false;  ///< the system keeps it from files and from the network
};
/// The end of a LevelTask. Without an error the file has the level's bytes.
struct LevelEnd {
  Status status{};
};
using DecodeAnswer = std::variant<DecoderReady, LevelEnd, CheckVerdict>;

[[nodiscard]] Bytes messageOf(const DecodeTask& task);
[[nodiscard]] Bytes messageOf(const DecodeAnswer& answer);
/// Errors: bad-value, truncated. An answer comes from a process that a hostile log may have taken
/// over, so nothing in it is trusted.
[[nodiscard]] Result<DecodeTask> taskOf(ByteView message);
[[nodiscard]] Result<DecodeAnswer> answerOf(ByteView message);

}  // namespace qtet
