#include "server/store/bus_guard.h"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>

namespace qtet {
namespace {

std::atomic<std::uint64_t> lost = 0;
std::uintptr_t pageBytes = 4096;

/// Async-signal-safe: a system call and an atomic. The fault comes again at once if the page cannot
/// be had; then as it would have ended without us.
void onBusError(int number, siginfo_t* info, void*) {
  const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr) / pageBytes * pageBytes;
  void* const page = reinterpret_cast<void*>(address);
  const bool behindTheEnd = info->si_code == BUS_ADRERR;
  if (behindTheEnd && ::mmap(page, pageBytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED,
                             -1, 0) != MAP_FAILED) {
    lost.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  ::signal(number, SIG_DFL);
}

}  // namespace

void guardAgainstBusErrors() {
  pageBytes = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  struct sigaction action{};
  action.sa_sigaction = onBusError;
  action.sa_flags = SA_SIGINFO;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(SIGBUS, &action, nullptr);
}

std::uint64_t lostPages() { return lost.load(std::memory_order_relaxed); }

}  // namespace qtet
