// A folder of one's own for as long as something is under way.
#pragma once

#include <filesystem>
#include <string_view>
#include <system_error>

namespace qtet {

/// Made where TMPDIR says (else /tmp), readable by nobody else, removed with everything in it. What
/// a process that was killed left there is removed by the next one of the same user and purpose:
/// each holds a lock on its folder as long as it lives.
class TemporaryFolder {
 public:
  /// `purpose` stands in its name: qtet-PURPOSE-XXXXXX. After a failure path() is empty.
  explicit TemporaryFolder(std::string_view purpose);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Why there is none.
  [[nodiscard]] const std::error_code& failure() const { return failure_; }

 private:
  std::filesystem::path path_;
  std::error_code failure_;
  int lock_ = -1;  // the folder itself, open
};

}  // namespace qtet
