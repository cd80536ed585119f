// The lock by which uploads, of several servers on one folder, let each other's parts alone.
#pragma once

#include <sys/file.h>

#include <cerrno>

namespace qtet {

/// Whether somebody else has the file locked; else it is now, until it is closed. Where the file
/// system has no locks nobody has.
[[nodiscard]] inline bool isLocked(int file) {
  return ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace qtet
