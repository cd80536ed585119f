// A folder of one's own for as long as something is under way.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace qtet {

/// A folder in TMPDIR (else /tmp), readable by nobody else, removed with everything in it. Each
/// process locks its folder as long as it lives. So the next process of the same user and purpose
/// can remove the folder of one that was killed.
class TemporaryFolder {
 public:
  /// `purpose` stands in its name: qtet-PURPOSE-XXXXXX. After a failure path() is empty.
  explicit TemporaryFolder(std::string_view purpose);
  /// The same as `parent`/PREFIXHOST-XXXXXX, where HOST is the machine's name: machines that share
  /// `parent` do not see each other's locks. REQUIRES: nobody else's folder there begins with
  /// `prefix`.
  TemporaryFolder(const std::filesystem::path& parent, const std::string& prefix);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Why there is none.
  [[nodiscard]] const std::error_code& failure() const { return failure_; }

 private:
  void make(const std::filesystem::path& parent, const std::string& prefix);

  std::filesystem::path path_;
  std::error_code failure_;
  int lock_ = -1;  // the folder itself, open
};

}  // namespace qtet
