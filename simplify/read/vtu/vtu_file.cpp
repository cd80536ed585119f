#include "simplify/read/vtu/vtu_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace qtet {

Result<VtuFile> VtuFile::open(const std::filesystem::path& path, std::chrono::seconds patience) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status{};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
    const std::string reason = std::strerror(errno);
    if (descriptor >= 0) ::close(descriptor);
    return fail(ErrorCode::kIo, "cannot read " + path.string() + ": " + reason);
  }
  return VtuFile(descriptor, static_cast<std::uint64_t>(status.st_size), path, patience);
}

VtuFile::VtuFile(VtuFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      path_(std::move(other.path_)),
      time_(other.time_) {}

VtuFile::~VtuFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status VtuFile::read(std::uint64_t at, std::span<std::byte> into) const {
  if (at > size_ || into.size() > size_ - at)
    return fail(ErrorCode::kTruncated,
                path_.string() + " ends before byte " + std::to_string(at) + " + " +
                    std::to_string(into.size()) + "; copy or export it again",
                at);
  if (Status inTime = time_.check(path_); !inTime) return inTime;
  while (!into.empty()) {
    const ssize_t got = ::pread(descriptor_, into.data(), into.size(), static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0)
      return fail(ErrorCode::kIo,
                  "cannot read " + path_.string() + ": " +
                      (got == 0 ? "it became shorter meanwhile" : std::strerror(errno)),
                  at);
    into = into.subspan(static_cast<std::size_t>(got));
    at += static_cast<std::uint64_t>(got);
  }
  return {};
}

std::unexpected<Error> VtuFile::bad(const std::string& what, std::uint64_t at) const {
  return fail(ErrorCode::kBadInput, path_.string() + ": " + what, at);
}

}  // namespace qtet
