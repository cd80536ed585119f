#include "codec/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

namespace qtet {
namespace {

Status systemError(const std::string& what, const std::filesystem::path& path, int number) {
  return fail(ErrorCode::kIo, "cannot " + what + " " + path.string() + ": " + std::strerror(number));
}

/// Owns a descriptor.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  [[nodiscard]] int get() const { return value_; }
  /// Closes now, so that a late write error is seen (network file systems report it here).
  int close() {
    const int result = value_ >= 0 ? ::close(value_) : 0;
    value_ = -1;
    return result;
  }

 private:
  int value_;
};

/// Beside the target, hidden, and different for each process and call.
std::filesystem::path temporaryName(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};
  const std::string suffix = "." + std::to_string(::getpid()) + "." + std::to_string(counter++) + ".tmp";
  return path.parent_path() / ("." + path.filename().string() + suffix);
}

Status writeAll(int descriptor, ByteView bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    // Linux writes at most 2^31 - 4096 bytes a call.
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return systemError("write", path, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Status writeNew(const std::filesystem::path& path, ByteView bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.get() < 0) return systemError("create", path, errno);
  if (Status status = writeAll(file.get(), bytes, path); !status) return status;
  if (::fsync(file.get()) != 0) return systemError("flush", path, errno);
  if (file.close() != 0) return systemError("write", path, errno);
  return {};
}

/// Makes the rename itself durable. File systems that cannot flush a folder say EINVAL: there is nothing more to do then.
Status flushFolder(const std::filesystem::path& folder) {
  const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor.get() < 0) return systemError("open the folder", folder, errno);
  if (::fsync(descriptor.get()) != 0 && errno != EINVAL) return systemError("flush the folder", folder, errno);
  return {};
}

}  // namespace

Status writeFileAtomically(const std::filesystem::path& path, ByteView bytes) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code code;
  if (!std::filesystem::is_directory(folder, code)) {
    return fail(ErrorCode::kNotFound, "the folder " + folder.string() + " does not exist; make it first or choose another output");
  }
  if (std::filesystem::is_directory(path, code)) {
    return fail(ErrorCode::kIo, path.string() + " is a folder; give the name of a file");
  }
  const std::filesystem::path temporary = temporaryName(path);
  Status status = writeNew(temporary, bytes);
  if (status && ::rename(temporary.c_str(), path.c_str()) != 0) status = systemError("rename to", path, errno);
  if (!status) {
    ::unlink(temporary.c_str());
    return status;
  }
  return flushFolder(folder);
}

}  // namespace qtet
