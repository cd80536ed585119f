// The system calls that write a file, so that a test can let any one of them fail or be the last.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>

namespace qtet {

/// Each does what the call of that name does: -1 and errno after a failure. `systemFileCalls` are
/// the real ones.
class FileCalls {
 public:
  virtual ~FileCalls() = default;
  virtual int open(const char* path, int flags, mode_t mode) = 0;
  virtual int lock(int descriptor, int operation) = 0;  ///< flock
  virtual ssize_t write(int descriptor, const std::uint8_t* bytes, std::size_t count) = 0;
  virtual int sync(int descriptor) = 0;  ///< fsync
  virtual int close(int descriptor) = 0;
  virtual int rename(const char* from, const char* to) = 0;
  virtual int unlink(const char* path) = 0;
};

[[nodiscard]] FileCalls& systemFileCalls();

}  // namespace qtet
