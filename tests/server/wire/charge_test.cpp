#include "server/wire/charge.h"

#include <gtest/gtest.h>

#include <ctime>
#include <string>
#include <thread>

namespace qtet {
namespace {

using namespace std::chrono_literals;

/// Uses the processor for that long.
void work(std::chrono::nanoseconds time) {
  const auto worked = [] {
    timespec now{};
    (void)::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
  };
  for (const auto end = worked() + time; worked() < end;) {
  }
}

bool counts(const Metrics& metrics, int turns) {
  return metrics.text({}).find("\nqtet_long_turns_total " + std::to_string(turns) + "\n") !=
         std::string::npos;
}

TEST(Charge, aTurnThatWorksLongIsCountedAndOneThatWaitsIsNot) {
  Metrics metrics;
  {
    const Charge charge(nullptr, &metrics, "mesh");
    std::this_thread::sleep_for(2 * limits::kLongTurn);
  }
  EXPECT_TRUE(counts(metrics, 0));
  for (int turns = 1; turns <= 2; ++turns) {
    const bool counted = [&] {
      const Charge charge(nullptr, &metrics, "mesh");
      work(limits::kLongTurn + 1ms);
      return counts(metrics, turns);
    }();
    EXPECT_FALSE(counted) << "at its end alone";
    EXPECT_TRUE(counts(metrics, turns));
  }
}

}  // namespace
}  // namespace qtet
