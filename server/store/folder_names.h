// The names of a folder's logs, read from the directory alone: no file is opened.
#pragma once

#include <dirent.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "proto/error.h"

namespace qtet {

inline constexpr std::string_view kLogSuffix = ".qtet";

class FolderNames {
 public:
  using Clock = std::chrono::steady_clock;

  /// Errors: io (the folder cannot be read), as those of read().
  [[nodiscard]] static Result<FolderNames> open(const std::filesystem::path& folder);

  /// Reads on until `end`, and at least one name. True: it has them all.
  [[nodiscard]] Result<bool> read(Clock::time_point end = Clock::time_point::max());
  /// The ids in order, each once. Not below the folder, and no link that leads out of it.
  [[nodiscard]] std::vector<std::string> take() &&;

 private:
  struct Close {
    void operator()(DIR* folder) const { ::closedir(folder); }
  };
  FolderNames(std::filesystem::path root, DIR* folder) : root_(std::move(root)), folder_(folder) {}

  std::filesystem::path root_;
  std::unique_ptr<DIR, Close> folder_;
  std::vector<std::string> ids_;
};

/// Whether `path` is a regular file, or a link to one in `root` (resolved already).
[[nodiscard]] bool isServable(const std::filesystem::path& path, const std::filesystem::path& root);

}  // namespace qtet
