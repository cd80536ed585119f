// One line of JSON for every request and every stream, in a file or on the standard output.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "proto/error.h"
#include "server/wire/request_trace.h"

namespace spdlog {
class logger;
}

namespace qtet {

/// The part of a line that only a PUT, DELETE or POST has.
struct ChangeEntry {
  std::string token{};  ///< its name; "": none, or one that nobody has
  std::string mesh{};   ///< "": the path is no mesh's
};

struct AccessEntry {
  std::string_view client;  ///< address
  std::string_view method;
  std::string_view target;
  unsigned status = 0;
  std::uint64_t bytes = 0;  ///< of the body, as far as they were sent
  std::chrono::nanoseconds time{};
  bool whole = true;  ///< the answer was sent to its end
  const ChangeEntry* change = nullptr;
  std::uint64_t received = 0;  ///< of a change's body
};

/// A stream, when it has ended.
struct StreamEntry {
  std::string_view mesh{};  ///< of the last `open`; "" without any
  std::string_view end{};   ///< why it ended
  std::uint64_t opens = 0, frames = 0, creditWaits = 0;
  std::uint64_t bytes = 0;  ///< that the network took
  std::chrono::nanoseconds time{}, stalled{};
  std::optional<std::chrono::nanoseconds> firstFrame{};  ///< of the first `open`
};

/// Thread-safe: `mutex_` guards which logger is used; spdlog guards each logger.
class AccessLog {
 public:
  /// `path` is a file, appended to, or "-" for the standard output. Errors: io.
  [[nodiscard]] static Result<std::unique_ptr<AccessLog>> open(const std::string& path);
  ~AccessLog();

  /// Goes on in a new file of the same name, as after a rotation. Errors: io; the old file stays.
  [[nodiscard]] Status reopen();

  void write(const AccessEntry& entry, const RequestTrace& trace);
  /// `client` and `target` as an AccessEntry has them.
  void write(const StreamEntry& entry, std::string_view client, std::string_view target,
             const RequestTrace& trace);

 private:
  AccessLog(std::string path, std::shared_ptr<spdlog::logger> logger);
  [[nodiscard]] std::shared_ptr<spdlog::logger> logger() const;

  const std::string path_;
  mutable std::mutex mutex_;
  std::shared_ptr<spdlog::logger> logger_;  // guarded by `mutex_`
};

}  // namespace qtet
