// Follows the store's folder with inotify: logs that come, change or go are served, or not, without
// a restart.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// Whether one of the kernel's inotify events is of a log's name, of the folder itself, or of lost
/// events. Other events are those of parts of uploads, and of the nameless copies that logs are
/// served from. A large folder must not be read again for each of them.
[[nodiscard]] bool tellOfLogs(ByteView events);

/// Runs `changed` on a thread of its own, limits::kFolderRest after a log in the folder has
/// changed. Runs it every limits::kFolderInterval in any case, since network folders report no
/// changes. For the thread that made it. Ends with the object, after a running call.
class FolderWatch {
 public:
  /// Errors: io (no inotify left, or no such folder).
  [[nodiscard]] static Result<FolderWatch> start(const std::filesystem::path& folder,
                                                 std::function<void()> changed);
  FolderWatch(FolderWatch&&) noexcept;
  FolderWatch& operator=(FolderWatch&&) = delete;
  ~FolderWatch();

 private:
  struct State;
  explicit FolderWatch(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace qtet
