// A temporary folder that goes also when the process that made it is killed, or crashes.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "codec/files/temporary_folder.h"
#include "proto/error.h"

namespace qtet {

/// A TemporaryFolder that belongs to a small process of its own session, the guard. The guard makes
/// the folder, waits for this process to end, however that comes about, and then removes it with
/// everything in it. So at no moment is there a folder without a guard. Where no guard can be
/// started the folder is this process' own. REQUIRES: made while this process has one thread.
class GuardedFolder {
 public:
  /// `purpose` stands in its name: qtet-PURPOSE-XXXXXX. After a failure path() is empty.
  explicit GuardedFolder(std::string_view purpose);
  ~GuardedFolder();
  GuardedFolder(const GuardedFolder&) = delete;
  GuardedFolder& operator=(const GuardedFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const {
    return unguarded_ ? unguarded_->path() : path_;
  }
  /// Why there is none.
  [[nodiscard]] const std::error_code& failure() const {
    return unguarded_ ? unguarded_->failure() : failure_;
  }
  /// Whether there is one. Error: io, with failure() and what to do.
  [[nodiscard]] Status made() const {
    if (!failure()) return {};
    return fail(ErrorCode::kIo, "no temporary folder could be made (" + failure().message() +
                                    "); let TMPDIR name one with room");
  }

 private:
  [[nodiscard]] bool startGuard(std::string_view purpose);

  std::filesystem::path path_;
  std::error_code failure_;
  pid_t guard_ = -1;
  // our end of a pipe on which the guard waits; closed with this process at the latest
  int life_ = -1;
  std::optional<TemporaryFolder> unguarded_;
};

}  // namespace qtet
