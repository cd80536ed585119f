#include "codec/files/temporary_folder.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <string>
#include <utility>

#include "codec/files/is_at.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPattern = "XXXXXX";

int openFolder(const fs::path& path) {
  return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

bool isOurs(int folder) {
  struct stat info{};
  return ::fstat(folder, &info) == 0 && info.st_uid == ::geteuid();
}

/// The folders of `parent` whose names are `prefix` and as much as mkdtemp() adds, that are this
/// user's and that nobody has locked.
void removeAbandoned(const fs::path& parent, const std::string& prefix) {
  std::error_code ec;
  for (fs::directory_iterator it(parent, ec), end; !ec && it != end; it.increment(ec)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with(prefix) || name.size() != prefix.size() + kPattern.size()) continue;
    const int folder = openFolder(it->path());
    if (folder < 0) continue;
    std::error_code ignored;
    if (isOurs(folder) && ::flock(folder, LOCK_EX | LOCK_NB) == 0 && isAt(it->path(), folder))
      fs::remove_all(it->path(), ignored);
    ::close(folder);
  }
}

}  // namespace

TemporaryFolder::TemporaryFolder(std::string_view purpose) {
  const fs::path parent = fs::temp_directory_path(failure_);
  if (!failure_) make(parent, "qtet-" + std::string(purpose) + "-");
}

TemporaryFolder::TemporaryFolder(const fs::path& parent, const std::string& prefix) {
  std::array<char, HOST_NAME_MAX + 1> host{};
  ::gethostname(host.data(), host.size() - 1);
  make(parent, prefix + host.data() + "-");
}

void TemporaryFolder::make(const fs::path& parent, const std::string& prefix) {
  removeAbandoned(parent, prefix);
  // somebody else may take a folder that has no lock yet for an abandoned one
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::string name = (parent / (prefix + std::string(kPattern))).string();
    if (::mkdtemp(name.data()) == nullptr) {
      failure_.assign(errno, std::generic_category());
      return;
    }
    lock_ = openFolder(name);
    const bool gone =
        lock_ < 0 ? errno == ENOENT : ::flock(lock_, LOCK_EX) == 0 && !isAt(name, lock_);
    if (!gone) {
      path_ = name;
      return;
    }
    if (lock_ >= 0) ::close(std::exchange(lock_, -1));
  }
  failure_ = std::make_error_code(std::errc::device_or_resource_busy);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace qtet
