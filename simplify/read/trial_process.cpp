#include "simplify/read/trial_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <new>
#include <string>
#include <thread>

namespace qtet {
namespace {

using Clock = std::chrono::steady_clock;

/// What the copy ends with where memory was refused.
constexpr int kRefusedMemory = 3;
/// Between two looks at the copy, at first and at most: short trials are not made longer by it.
constexpr std::chrono::microseconds kFirstPause{200}, kLongestPause{50'000};

/// Sanitizers reserve more addresses than any machine has memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kBoundsMemory = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kBoundsMemory = false;
#else
constexpr bool kBoundsMemory = true;
#endif
#else
constexpr bool kBoundsMemory = true;
#endif

void boundMemory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), bytes = ::sysconf(_SC_PAGESIZE);
  if (!kBoundsMemory || pages <= 0 || bytes <= 0) return;
  const rlim_t all = static_cast<rlim_t>(pages) * static_cast<rlim_t>(bytes);
  rlimit data{};
  if (::getrlimit(RLIMIT_DATA, &data) != 0) return;
  data.rlim_cur = std::min(data.rlim_max, all);
  ::setrlimit(RLIMIT_DATA, &data);
}

[[noreturn]] void runQuietly(const std::function<void()>& work, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(0);  // it died before that
  const int nowhere = ::open("/dev/null", O_RDWR);
  if (nowhere >= 0) {
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
  }
  const rlimit noCoreFile{0, 0};
  ::setrlimit(RLIMIT_CORE, &noCoreFile);
  boundMemory();
  try {
    work();
  } catch (const std::bad_alloc&) {
    ::_exit(kRefusedMemory);
  } catch (...) {
    // An exception is an orderly end: the caller will meet it again and handle it.
  }
  ::_exit(0);
}

/// Bytes that the process has read so far; 0 where the system does not tell.
std::uint64_t bytesReadBy(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/io");
  std::uint64_t bytes = 0;
  for (std::string name; file >> name >> bytes;)
    if (name == "rchar:") return bytes;
  return 0;
}

TrialEnd endOf(int status) {
  if (!WIFEXITED(status)) return TrialEnd::kCrashed;
  if (WEXITSTATUS(status) == kRefusedMemory) return TrialEnd::kOutOfMemory;
  return WEXITSTATUS(status) == 0 ? TrialEnd::kDone : TrialEnd::kCrashed;
}

}  // namespace

TrialEnd tryOut(const std::function<void()>& work, std::chrono::seconds patience) {
  const pid_t parent = ::getpid(), child = ::fork();
  if (child == 0) runQuietly(work, parent);
  if (child < 0) return TrialEnd::kCrashed;
  std::uint64_t read = 0;
  Clock::time_point last = Clock::now();
  for (auto pause = kFirstPause;; pause = std::min(2 * pause, kLongestPause)) {
    int status = 0;
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child) return endOf(status);
    if (ended < 0 && errno != EINTR) return TrialEnd::kCrashed;
    if (const std::uint64_t now = bytesReadBy(child); now != read) read = now, last = Clock::now();
    if (Clock::now() - last > patience) {
      ::kill(child, SIGKILL);
      while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
      }
      return TrialEnd::kStuck;
    }
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace qtet
