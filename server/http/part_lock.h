// The lock by which uploads, of several servers on one folder, let each other's parts alone.
#pragma once

#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>

namespace qtet {

/// Whether somebody else has the file locked; else it is now, until it is closed. Where the file
/// system has no locks nobody has.
[[nodiscard]] inline bool isLocked(int file) {
  return ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

/// Whether the file has its name still: between our opening and our locking it another server may
/// have published or removed it.
[[nodiscard]] inline bool isAt(const std::filesystem::path& path, int file) {
  struct stat opened{}, named{};
  return ::fstat(file, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace qtet
