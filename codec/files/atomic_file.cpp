#include "codec/files/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>

#include "codec/files/buffered_file.h"
#include "codec/files/unreachable.h"
#include "proto/crc32c.h"

namespace qtet {
namespace {

namespace fs = std::filesystem;

Status systemError(const std::string& what, const fs::path& path, int number) {
  return fail(ErrorCode::kIo,
              "cannot " + what + " " + path.string() + ": " + std::strerror(number));
}

Result<fs::path> folderOf(const fs::path& path) {
  fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code code;
  if (fs::is_directory(folder, code)) return folder;
  if (isUnreachable(code))
    return fail(ErrorCode::kIo, "the folder " + folder.string() + " cannot be reached: " +
                                    code.message() + "; choose another output");
  return fail(ErrorCode::kNotFound, "the folder " + folder.string() +
                                        " does not exist; make it first or choose another output");
}

/// Owns a descriptor.
class Descriptor {
 public:
  Descriptor(FileCalls& calls, int value) : calls_(calls), value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  // After a flush that succeeded a close has nothing left to report.
  ~Descriptor() {
    if (value_ >= 0) calls_.close(value_);
  }

  [[nodiscard]] int get() const { return value_; }

 private:
  FileCalls& calls_;
  int value_;
};

/// How the temporary files of all writers of `path` name it. A name that leaves no room for the
/// rest gives its hash.
std::string nameWithin(const fs::path& path) {
  constexpr std::size_t kMaxOfName = 200;  // bytes of the 255 that a file's name may have
  std::string name = path.filename().string();
  if (name.size() > kMaxOfName)
    name = name.substr(0, kMaxOfName - 10) + "~" +
           std::to_string(
               crc32c(ByteView(reinterpret_cast<const std::uint8_t*>(name.data()), name.size())));
  return name;
}
constexpr std::string_view kTemporarySuffix = ".tmp";

/// Beside the target, hidden, and different for each process and call.
fs::path temporaryName(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  const std::string number = std::to_string(::getpid()) + "." + std::to_string(counter++);
  return path.parent_path() /
         ("." + nameWithin(path) + "." + number + std::string(kTemporarySuffix));
}

/// The NAME of .NAME.digits.digits.tmp; "" of anything else, so that no file of somebody else's is
/// taken for ours.
std::string_view nameOf(std::string_view temporary) {
  if (!temporary.starts_with('.') || !temporary.ends_with(kTemporarySuffix)) return "";
  std::string_view name = temporary.substr(1, temporary.size() - 1 - kTemporarySuffix.size());
  for (int number = 0; number < 2; ++number) {
    const std::size_t dot = name.rfind('.');
    if (dot == name.npos || dot + 1 == name.size() ||
        name.find_first_not_of("0123456789", dot + 1) != name.npos)
      return "";
    name = name.substr(0, dot);
  }
  return name;
}

/// Whether the file has lost its name: somebody removed it between our opening and our locking it.
bool unlinked(int descriptor) {
  struct stat info{};
  return ::fstat(descriptor, &info) == 0 && info.st_nlink == 0;
}

/// Creates a temporary file for `path` and locks it, as far as the file system has locks; -1 and
/// errno after a failure.
int createLocked(const fs::path& path, fs::path& temporary, FileCalls& calls) {
  // A name may be taken by a process that had this number before and was killed, or by one on
  // another machine.
  constexpr int kAttempts = 1000;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    temporary = temporaryName(path);
    const int file = calls.open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST) return -1;
    if (file < 0) continue;
    if (calls.lock(file, LOCK_EX) != 0 || !unlinked(file)) return file;
    calls.close(file);
  }
  errno = EEXIST;
  return -1;
}

/// The whole of it but the folder's flush. The lock is held until the file has its final name.
/// `mode`: of the file that it takes the place of.
Status writeAndRename(const fs::path& path, std::optional<mode_t> mode, const ByteSource& content,
                      FileCalls& calls) {
  fs::path temporary;
  const Descriptor file(calls, createLocked(path, temporary, calls));
  if (file.get() < 0) return systemError("create", temporary, errno);
  Status status;
  if (mode && ::fchmod(file.get(), *mode) != 0)
    status = systemError("keep the permissions of", path, errno);
  BufferedFile out(file.get(), calls);
  const auto isWritten = [&](bool done) {
    return done ? Status{} : systemError("write", path, errno);
  };
  if (status) status = content([&](ByteView bytes) { return isWritten(out.write(bytes)); });
  if (status) status = isWritten(out.flush());
  if (status && calls.sync(file.get()) != 0) status = systemError("write", path, errno);
  if (status && calls.rename(temporary.c_str(), path.c_str()) != 0)
    status = systemError("rename a new file to", path, errno);
  if (!status) calls.unlink(temporary.c_str());
  return status;
}

}  // namespace

void removeUnfinished(const fs::path& folder,
                      const std::function<bool(std::string_view name)>& isOurs, FileCalls& calls) {
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    const std::string temporary = at->path().filename().string();
    if (const std::string_view name = nameOf(temporary); name.empty() || !isOurs(name)) continue;
    const Descriptor stale(
        calls, calls.open(at->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0));
    // Still under its name when the lock is ours: so nobody else removes it now, nor puts a new
    // file there.
    if (stale.get() >= 0 && calls.lock(stale.get(), LOCK_EX | LOCK_NB) == 0 &&
        !unlinked(stale.get()))
      calls.unlink(at->path().c_str());
  }
}

Result<fs::path> fileBehindLinks(const fs::path& asked) {
  constexpr int kMaxLinks = 40;  // as many as Linux follows (path_resolution(7))
  fs::path path = asked;
  std::error_code code;
  for (int links = 0; fs::is_symlink(path, code); ++links) {
    const fs::path next = links < kMaxLinks ? fs::read_symlink(path, code) : fs::path();
    if (next.empty())
      return fail(ErrorCode::kIo, asked.string() +
                                      " is a link that leads nowhere, or through too many others; "
                                      "remove it or choose another output");
    path = path.parent_path() / next;  // an absolute one takes the place of the whole
  }
  return path;
}

Result<fs::path> folderBehindLinks(const fs::path& path) {
  const Result<fs::path> behind = fileBehindLinks(path);
  return behind ? folderOf(*behind) : behind;
}

Status writeFileAtomically(const fs::path& asked, ByteView bytes, FileCalls& calls) {
  return writeFileAtomically(asked, [bytes](const ByteSink& sink) { return sink(bytes); }, calls);
}

Status writeFileAtomically(const fs::path& asked, const ByteSource& content, FileCalls& calls,
                           Leftovers leftovers) {
  const Result<fs::path> behind = fileBehindLinks(asked);
  if (!behind) return std::unexpected(behind.error());
  const fs::path& path = *behind;
  const Result<fs::path> found = folderOf(path);
  if (!found) return std::unexpected(found.error());
  const fs::path& folder = *found;
  if (std::error_code code; fs::is_directory(path, code)) {
    return fail(ErrorCode::kIo, path.string() + " is a folder; give the name of a file");
  }
  struct stat old{};
  const bool replaces = ::stat(path.c_str(), &old) == 0;
  if (replaces && !S_ISREG(old.st_mode))
    return fail(ErrorCode::kIo, path.string() + " is a pipe or a device; give the name of a file");
  // Opened before anything is changed: what cannot be flushed later is better not begun.
  const Descriptor opened(calls, calls.open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC, 0));
  if (opened.get() < 0) return systemError("open the folder", folder, errno);
  if (leftovers == Leftovers::kRemove)
    removeUnfinished(
        folder, [own = nameWithin(path)](std::string_view name) { return name == own; }, calls);
  if (Status status = writeAndRename(
          path, replaces ? std::optional(old.st_mode & 07777) : std::nullopt, content, calls);
      !status)
    return status;
  // Makes the rename itself durable. File systems that cannot flush a folder say EINVAL: there is
  // nothing more to do then.
  if (calls.sync(opened.get()) == 0 || errno == EINVAL) return {};
  return fail(ErrorCode::kIo,
              path.string() +
                  " is written, but a power failure may still undo it: cannot flush the folder " +
                  folder.string() + ": " + std::strerror(errno));
}

}  // namespace qtet
