// How a file takes its name in a folder that servers share: under the folder's lock, at once, and
// kept across a power failure.
#pragma once

#include <filesystem>

#include "proto/error.h"

namespace qtet {

/// While it lives no other server that shares the folder changes what is published in it. Where the
/// file system has no locks, what RENAME_NOREPLACE guards is guarded alone.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  const int file_;
};

/// Renames `part` to `target`: 0 or errno. `newly`: EEXIST where there is something of that name.
[[nodiscard]] int publishAs(const std::filesystem::path& part, const std::filesystem::path& target,
                            bool newly);

/// The names in the folder are on the disk now. Errors: io.
[[nodiscard]] Status syncFolder(const std::filesystem::path& folder);

}  // namespace qtet
