#include "server/http/publishing.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace qtet {

namespace fs = std::filesystem;

FolderLock::FolderLock(const fs::path& folder)
    : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  while (file_ >= 0 && ::flock(file_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

int publishAs(const fs::path& part, const fs::path& target, bool newly) {
  if (newly) {
    if (::renameat2(AT_FDCWD, part.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE) == 0)
      return 0;
    // EINVAL: the file system does not know how
    if (errno != EINVAL && errno != ENOSYS) return errno;
  }
  return ::rename(part.c_str(), target.c_str()) == 0 ? 0 : errno;
}

Status syncFolder(const fs::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool done = file >= 0 && ::fsync(file) == 0;
  const int number = errno;
  if (file >= 0) ::close(file);
  return done ? Status() : fail(ErrorCode::kIo, folder.string() + ": " + std::strerror(number));
}

}  // namespace qtet
