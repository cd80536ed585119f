#include "simplify/read/process/inflate_file.h"

#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <vector>

#include "simplify/read/options/byte_order_mark.h"
#include "simplify/read/process/guarded_folder.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kPieceBytes = 1U << 20;

/// A gzip file that is open for reading while this lives.
class GzipFile {
 public:
  explicit GzipFile(const fs::path& path) : file_(::gzopen(path.c_str(), "rb")) {}
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;
  ~GzipFile() {
    if (file_) ::gzclose_r(file_);
  }
  [[nodiscard]] bool isOpen() const { return file_ != nullptr; }
  [[nodiscard]] bool isPlain() const { return ::gzdirect(file_) == 1; }
  /// Less than the piece at the end or after an error, which error() tells.
  [[nodiscard]] int read(std::span<char> piece) const {
    return ::gzread(file_, piece.data(), static_cast<unsigned>(piece.size()));
  }
  [[nodiscard]] int error() const {
    int code = Z_OK;
    ::gzerror(file_, &code);
    return code;
  }

 private:
  gzFile file_;
};

std::unexpected<Error> damaged(const fs::path& path, int code) {
  if (code == Z_BUF_ERROR)
    return fail(ErrorCode::kTruncated,
                path.string() +
                    " ends within its compressed bytes: it was cut off; copy or compress it again");
  return fail(ErrorCode::kBadInput,
              path.string() + " is damaged: it does not inflate; copy or compress it again");
}

Status inflateTo(const fs::path& file, const fs::path& path, std::uint64_t most) {
  const GzipFile in(path);
  if (!in.isOpen())
    return fail(ErrorCode::kIo, "cannot read " + path.string() + ": " + std::strerror(errno));
  std::ofstream out(file, std::ios::binary);
  std::vector<char> piece(kPieceBytes);
  std::uint64_t bytes = 0;
  for (;;) {
    const int got = in.read(piece);
    if (bytes == 0 && in.isPlain())
      return fail(ErrorCode::kBadInput,
                  path.string() + " is not compressed by gzip; rename it if it is a plain file");
    if (got < 0) return damaged(path, in.error());
    bytes += static_cast<std::uint64_t>(got);
    if (bytes > most)
      return fail(ErrorCode::kLimitExceeded,
                  path.string() + " inflates to more than " + std::to_string(most) +
                      " bytes, which this machine has no memory for; inflate it by hand if you "
                      "trust it");
    out.write(piece.data(), got);
    if (!out)
      return fail(ErrorCode::kIo, "what " + path.string() + " inflates to does not fit into " +
                                      file.parent_path().parent_path().string() +
                                      "; let TMPDIR name a folder with room");
    if (static_cast<unsigned>(got) < piece.size()) break;
  }
  if (in.error() != Z_OK && in.error() != Z_STREAM_END) return damaged(path, in.error());
  out.close();
  if (out) return {};
  return fail(ErrorCode::kIo, "no room for what " + path.string() +
                                  " inflates to; let TMPDIR name a folder with "
                                  "room");
}

/// use(file), whose error then names `path` in place of the file.
Status usedFor(const fs::path& path, const fs::path& file,
               const std::function<Status(const fs::path&)>& use) {
  Status used = use(file);
  if (!used) used.error().message = withName(used.error().message, file.string(), path.string());
  return used;
}

}  // namespace

std::uint64_t maxInflatedBytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), bytes = ::sysconf(_SC_PAGESIZE);
  constexpr std::uint64_t kIfUnknown = std::uint64_t{16} << 30;
  if (pages <= 0 || bytes <= 0) return kIfUnknown;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(bytes);
}

std::string withName(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

Result<std::string> beginningOf(const fs::path& path, std::size_t bytes) {
  const GzipFile in(path);
  std::string out(bytes, '\0');
  const int got = in.isOpen() ? in.read(out) : -1;
  if (got < 0 && in.isOpen() && !in.isPlain()) return damaged(path, in.error());
  if (got < 0)
    return fail(ErrorCode::kIo, "cannot read " + path.string() + ": " + std::strerror(errno));
  out.resize(static_cast<std::size_t>(got));
  return out;
}

Status inflated(const fs::path& path, const std::function<Status(const fs::path&)>& use,
                std::uint64_t most) {
  const GuardedFolder folder("inflate");
  if (Status made = folder.made(); !made) return std::unexpected(made.error());
  const fs::path file = folder.path() / path.stem();
  if (Status done = inflateTo(file, path, most); !done) return done;
  return usedFor(path, file, use);
}

Status unmarked(const fs::path& path, const std::function<Status(const fs::path&)>& use) {
  const GuardedFolder folder("unmark");
  if (Status made = folder.made(); !made) return std::unexpected(made.error());
  const fs::path file = folder.path() / path.filename();
  std::ifstream in(path, std::ios::binary);
  passMark(in);
  std::ofstream out(file, std::ios::binary);
  out << in.rdbuf();
  out.close();
  if (!in || !out)
    return fail(ErrorCode::kIo, "cannot copy " + path.string() +
                                    " without its byte order mark; let TMPDIR name a folder with "
                                    "room");
  return usedFor(path, file, use);
}

}  // namespace qtet
