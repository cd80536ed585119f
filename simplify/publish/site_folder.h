// A folder of files that appears whole or not at all, also where an earlier one stands.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "proto/bytes.h"
#include "proto/error.h"

namespace qtet {

/// The folder's list of files, which publishing makes and a later one asks for.
inline constexpr const char* kSiteList = "index.json";

/// The file's bytes. Error: io (it cannot be read).
[[nodiscard]] Result<Bytes> readWhole(const std::filesystem::path& path);

/// Written beside its place under a hidden name, which is removed with the object; a process that
/// is killed leaves `.NAME.XXXXXX`.
class SiteFolder {
 public:
  /// Begins a folder at `place`: there is nothing yet, or an empty folder, or one that an earlier
  /// publication made. The last holds nothing else: its kSiteList names every file in `files`. A
  /// symbolic link stays, and the folder behind it is made. Errors: io (something else is there,
  /// with its name; nothing can be written beside it), not-found (no folder to be in).
  [[nodiscard]] static Result<SiteFolder> begin(const std::filesystem::path& place);
  SiteFolder(SiteFolder&& other) noexcept;
  SiteFolder& operator=(SiteFolder&&) = delete;
  ~SiteFolder();

  /// Writes a file; `name` is relative, with / between folders, which are made. REQUIRES: no name
  /// twice. Errors: those of writeFileAtomically.
  [[nodiscard]] Status write(const std::string& name, ByteView bytes);
  /// The names so far, ascending.
  [[nodiscard]] const std::set<std::string>& files() const { return files_; }
  /// Puts the folder in its place, in one step where the file system has one; what was there is
  /// removed. Nothing can be written afterwards. Errors: io (what was there is there still).
  [[nodiscard]] Status finish();

 private:
  SiteFolder() = default;

  std::filesystem::path place_, hidden_;
  std::set<std::string> files_;
};

}  // namespace qtet
