#include "codec/files/file_spool.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "codec/files/atomic_file.h"
#include "codec/files/buffered_file.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

// Bytes that are read at once.
constexpr std::size_t kPieceBytes = 1 << 20;

std::unexpected<Error> failed(const char* what, const fs::path& folder) {
  return fail(ErrorCode::kIo, std::string("cannot ") + what + " a temporary file in " +
                                  folder.string() + ": " + std::strerror(errno));
}

class FileSpool final : public ByteSpool {
 public:
  FileSpool(int file, fs::path folder, FileCalls& calls)
      : calls_(calls), file_(file), folder_(std::move(folder)), buffer_(file, calls) {}
  FileSpool(const FileSpool&) = delete;
  FileSpool& operator=(const FileSpool&) = delete;
  ~FileSpool() override { calls_.close(file_); }

  Status append(ByteView bytes) override {
    if (!buffer_.write(bytes)) return failed("write", folder_);
    size_ += bytes.size();
    return {};
  }
  [[nodiscard]] std::uint64_t size() const override { return size_; }

  [[nodiscard]] Status read(std::uint64_t at, std::span<std::uint8_t> into) const override {
    assert(at <= size_ && into.size() <= size_ - at);
    if (!buffer_.flush()) return failed("write", folder_);
    while (!into.empty()) {
      const ssize_t got = ::pread(file_, into.data(), into.size(), static_cast<off_t>(at));
      if (got < 0 && errno == EINTR) continue;
      if (got == 0) errno = EIO;
      if (got <= 0) return failed("read", folder_);
      into = into.subspan(static_cast<std::size_t>(got));
      at += static_cast<std::uint64_t>(got);
    }
    return {};
  }

  [[nodiscard]] Status writeTo(const ByteSink& sink) const override {
    Bytes piece(std::min<std::uint64_t>(kPieceBytes, size_));
    for (std::uint64_t at = 0; at < size_; at += piece.size()) {
      const auto own = std::span(piece).first(std::min<std::uint64_t>(piece.size(), size_ - at));
      if (Status s = read(at, own); !s) return s;
      if (Status s = sink(own); !s) return s;
    }
    return {};
  }

 private:
  FileCalls& calls_;
  int file_;
  fs::path folder_;
  mutable BufferedFile buffer_;
  std::uint64_t size_ = 0;
};

/// A file without a name; -1 and errno after a failure.
int openNameless(const fs::path& folder, FileCalls& calls) {
  const int file = calls.open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  // a file system or kernel without such files
  if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)) return file;
  std::string name = (folder / ".qtet-XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) calls.unlink(name.c_str());
  return named;
}

}  // namespace

Result<std::unique_ptr<ByteSpool>> fileSpoolBeside(const fs::path& beside, FileCalls& calls) {
  const Result<fs::path> folder = folderBehindLinks(beside);
  if (!folder) return std::unexpected(folder.error());
  const int file = openNameless(*folder, calls);
  if (file < 0) return failed("make", *folder);
  return std::make_unique<FileSpool>(file, *folder, calls);
}

}  // namespace qtet
