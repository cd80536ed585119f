// One line of JSON for every request, in a file or on the standard output.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "proto/error.h"
#include "server/wire/request_trace.h"

namespace spdlog {
class logger;
}

namespace qtet {

struct AccessEntry {
  std::string_view client;  ///< address
  std::string_view method;
  std::string_view target;
  unsigned status = 0;
  std::uint64_t bytes = 0;  ///< of the body, as far as they were sent
  std::chrono::nanoseconds time{};
  bool whole = true;  ///< the answer was sent to its end
};

/// Thread-safe.
class AccessLog {
 public:
  /// `path` is a file, appended to, or "-" for the standard output. Errors: io.
  [[nodiscard]] static Result<std::unique_ptr<AccessLog>> open(const std::string& path);
  ~AccessLog();

  void write(const AccessEntry& entry, const RequestTrace& trace);

 private:
  explicit AccessLog(std::shared_ptr<spdlog::logger> logger);
  std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace qtet
