#include "simplify/read/process/trial_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <new>
#include <optional>

#include "simplify/read/process/watch_process.h"

namespace qtet {
namespace {

/// The copy's exit code where memory was refused.
constexpr int kRefusedMemory = 3;

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
  const std::optional<int> status = watchProcess(child, patience);
  return status ? endOf(*status) : TrialEnd::kStuck;
}

}  // namespace qtet
