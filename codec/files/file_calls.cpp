#include "codec/files/file_calls.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdio>

namespace qtet {
namespace {

class SystemFileCalls final : public FileCalls {
 public:
  int open(const char* path, int flags, mode_t mode) override { return ::open(path, flags, mode); }
  int lock(int descriptor, int operation) override { return ::flock(descriptor, operation); }
  ssize_t write(int descriptor, const std::uint8_t* bytes, std::size_t count) override {
    return ::write(descriptor, bytes, count);
  }
  int sync(int descriptor) override { return ::fsync(descriptor); }
  int close(int descriptor) override { return ::close(descriptor); }
  int rename(const char* from, const char* to) override { return ::rename(from, to); }
  int unlink(const char* path) override { return ::unlink(path); }
};

}  // namespace

FileCalls& systemFileCalls() {
  static SystemFileCalls calls;
  return calls;
}

}  // namespace qtet
