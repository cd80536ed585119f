#include "simplify/read/process/watch_process.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <string>
#include <thread>

#include "proto/sanitizer.h"

namespace qtet {
namespace {

/// Between two looks at the copy, at first and at most: short trials are not made longer by it.
constexpr std::chrono::microseconds kFirstPause{200}, kLongestPause{50'000};

/// Bytes that the process has read and written so far; 0 where the system does not report them.
std::uint64_t bytesMovedBy(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/io");
  std::uint64_t bytes = 0, moved = 0;
  for (std::string name; file >> name >> bytes;)
    if (name == "rchar:" || name == "wchar:") moved += bytes;
  return moved;
}

}  // namespace

void boundMemory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), bytes = ::sysconf(_SC_PAGESIZE);
  if (kSanitized || pages <= 0 || bytes <= 0) return;
  const rlim_t all = static_cast<rlim_t>(pages) * static_cast<rlim_t>(bytes);
  rlimit data{};
  if (::getrlimit(RLIMIT_DATA, &data) != 0) return;
  data.rlim_cur = std::min(data.rlim_max, all);
  ::setrlimit(RLIMIT_DATA, &data);
}

bool ProcessWatch::isStuck() {
  const auto now = std::chrono::steady_clock::now();
  if (const std::uint64_t moved = bytesMovedBy(process_); moved != moved_)
    moved_ = moved, last_ = now;
  return now - last_ > patience_;
}

std::optional<int> watchProcess(pid_t child, std::chrono::seconds patience) {
  ProcessWatch watch(child, patience);
  for (auto pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    int status = 0;
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return SIGKILL;  // somebody else has waited for it
    if (watch.isStuck()) {
      ::kill(child, SIGKILL);
      while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
      }
      return std::nullopt;
    }
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace qtet
