// User CPU and wall seconds of a stretch of code, and a process that stays on given cores: what a
// speed comparison needs.
#pragma once

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace qtet::bench {

struct Seconds {
  double user = 0, wall = 0;
};

[[nodiscard]] inline double userSecondsOf(const rusage& usage) {
  return static_cast<double>(usage.ru_utime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

/// Returns the seconds of this process with all its threads, while `work` ran.
template <class Work>
[[nodiscard]] Seconds timeOf(const Work& work) {
  const auto userNow = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return userSecondsOf(usage);
  };
  const double user = userNow();
  const auto wall = std::chrono::steady_clock::now();
  work();
  return {userNow() - user,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count()};
}

/// Keeps this process and what it starts on the last `count` of the cores that it may use:
/// interrupts favour the first. False if refused.
inline bool pinToCores(int count) {
  cpu_set_t allowed, chosen;
  CPU_ZERO(&chosen);
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return false;
  for (int core = CPU_SETSIZE - 1; core >= 0 && CPU_COUNT(&chosen) < count; --core)
    if (CPU_ISSET(core, &allowed)) CPU_SET(core, &chosen);
  return sched_setaffinity(0, sizeof chosen, &chosen) == 0;
}

/// The median, the upper one of an even number of values. REQUIRES: not empty.
[[nodiscard]] inline double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace qtet::bench
