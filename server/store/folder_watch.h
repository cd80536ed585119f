// Follows the store's folder with inotify: logs that come, change or go are served, or not, without
// a restart.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "proto/error.h"

namespace qtet {

/// Runs `changed` on a thread of its own, limits::kFolderRest after something in the folder has
/// changed. Runs it every limits::kFolderInterval in any case, since network folders report no
/// changes. Ends with the object, after a running call.
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
