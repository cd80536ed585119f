#include "simplify/read/process/guarded_folder.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

namespace qtet {
namespace {

/// Reads until the other side closes the pipe, or until `most` bytes.
std::string readAll(int pipe, std::size_t most) {
  std::string text;
  char piece[512];
  for (ssize_t count = 0; text.size() < most && ((count = ::read(pipe, piece, sizeof piece)) > 0 ||
                                                 (count < 0 && errno == EINTR));)
    if (count > 0) text.append(piece, static_cast<std::size_t>(count));
  return text;
}

void writeAll(int pipe, std::string_view text) {
  for (ssize_t count = 0; !text.empty() && ((count = ::write(pipe, text.data(), text.size())) > 0 ||
                                            (count < 0 && errno == EINTR));)
    if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
}

/// The guard's process: makes the folder, answers with an errno and the folder's path, and waits
/// until `life` is closed.
[[noreturn]] void guard(int life, int answer, std::string_view purpose) {
  ::setsid();  // a terminal's Ctrl-C is for the others
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(number, SIG_IGN);
  // Nothing stays open but the two pipes, so that no lock, socket or terminal lives longer for it.
  const auto [low, high] =
      std::minmax({static_cast<unsigned>(life), static_cast<unsigned>(answer)});
  if (low > 0) ::close_range(0, low - 1, 0);
  if (high - low > 1) ::close_range(low + 1, high - 1, 0);
  ::close_range(high + 1, ~0u, 0);
  {
    const TemporaryFolder folder(purpose);
    const int code = folder.failure().value();
    writeAll(answer, {reinterpret_cast<const char*>(&code), sizeof code});
    writeAll(answer, folder.path().native());
    ::close(answer);
    (void)readAll(life, 1);
  }
  ::_exit(0);
}

/// A pipe's two ends, closed unless they are taken.
struct Pipe {
  int ends[2] = {-1, -1};
  bool made = ::pipe2(ends, O_CLOEXEC) == 0;
  ~Pipe() {
    for (const int end : ends)
      if (end >= 0) ::close(end);
  }
  [[nodiscard]] int take(int side) {
    const int end = ends[side];
    ends[side] = -1;
    return end;
  }
};

}  // namespace

bool GuardedFolder::startGuard(std::string_view purpose) {
  Pipe life, answer;
  if (!life.made || !answer.made) return false;
  guard_ = ::fork();
  if (guard_ < 0) return false;
  if (guard_ == 0) guard(life.ends[0], answer.ends[1], purpose);
  ::close(answer.take(1));
  constexpr std::size_t kMaxBytes = 64 * 1024;  // far beyond PATH_MAX
  const std::string text = readAll(answer.ends[0], kMaxBytes);
  int code = 0;
  if (text.size() < sizeof code) return false;
  std::memcpy(&code, text.data(), sizeof code);
  failure_.assign(code, std::generic_category());
  path_ = text.substr(sizeof code);
  life_ = life.take(1);
  return true;
}

GuardedFolder::GuardedFolder(std::string_view purpose) {
  if (!startGuard(purpose)) unguarded_.emplace(purpose);
}

GuardedFolder::~GuardedFolder() {
  if (life_ >= 0) ::close(life_);
  while (guard_ > 0 && ::waitpid(guard_, nullptr, 0) < 0 && errno == EINTR) {
  }
  std::error_code ignored;
  // gone, unless somebody killed the guard
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace qtet
