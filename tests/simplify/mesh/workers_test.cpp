#include "simplify/mesh/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <stdexcept>
#include <thread>

#include "simplify/mesh/stopping.h"

namespace qtet {
namespace {

TEST(ThreadsAtOnce, areNoMoreThanTheMachineRuns) {
  EXPECT_EQ(threadsAtOnce(1), 1);
  const int all = threadsAtOnce(1 << 20);
  EXPECT_GE(all, 1);
  EXPECT_LE(all, std::max(1u, std::thread::hardware_concurrency()));
  EXPECT_EQ(threadsAtOnce(all), all);
}

class OfThreads : public ::testing::TestWithParam<int> {};

TEST_P(OfThreads, everyItemIsDoneOnceByAWorkerThatThereIs) {
  Workers workers(GetParam());
  for (const std::size_t n : {0u, 1u, 7u, 8u, 9u, 1000u}) {
    std::vector<std::atomic<int>> times(n);
    workers.forEach(n, 8, [&](std::size_t worker, std::size_t i) {
      EXPECT_LT(worker, workers.count());
      ++times[i];
    });
    for (const auto& t : times) EXPECT_EQ(t, 1);
  }
}

TEST_P(OfThreads, aStopEndsTheJobAndEveryJobAfterIt) {
  std::stop_source stop;
  Workers workers(GetParam(), stop.get_token());
  std::atomic<std::size_t> done{0};
  const auto work = [&](std::size_t, std::size_t) {
    if (++done == 100) stop.request_stop();
  };
  EXPECT_THROW(workers.forEach(100000, 8, work), Stopped);
  EXPECT_LT(done, 1000u) << "each worker ends with the grain in hand";
  const std::size_t before = done;
  EXPECT_THROW(workers.forEach(10, 64, work), Stopped);
  EXPECT_EQ(done, before);
}

TEST_P(OfThreads, runsCoverAllAndDoNotOverlap) {
  Workers workers(GetParam());
  std::vector<std::atomic<int>> times(1001);
  workers.forRuns(times.size(), 64, [&](std::size_t begin, std::size_t end) {
    EXPECT_LE(end - begin, 64u);
    for (std::size_t i = begin; i < end; ++i) ++times[i];
  });
  for (const auto& t : times) EXPECT_EQ(t, 1);
}

TEST_P(OfThreads, thousandsOfShortJobsFollowOneAnother) {
  Workers workers(GetParam());
  std::atomic<std::size_t> sum{0};
  for (std::size_t job = 0; job < 5000; ++job)
    workers.forEach(40, 8, [&](std::size_t, std::size_t i) { sum += i; });
  EXPECT_EQ(sum, 5000u * (40 * 39 / 2));
}

TEST_P(OfThreads, anExceptionEndsTheJobAndNotTheWorkers) {
  Workers workers(GetParam());
  const auto fails = [](std::size_t, std::size_t i) {
    if (i == 77) throw std::runtime_error("at 77");
  };
  EXPECT_THROW(workers.forEach(1000, 8, fails), std::runtime_error);
  std::atomic<int> done{0};
  workers.forEach(100, 8, [&](std::size_t, std::size_t) { ++done; });
  EXPECT_EQ(done, 100);
}

/// Processor time of this process.
std::chrono::duration<double, std::milli> processorTime() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

constexpr std::chrono::milliseconds kLongWait{300};

/// The most CPU time that the waiting threads may take. Sleeping between looks takes a sixth of the
/// wait; spinning would take all of it, and no less than half on a busy machine.
double maxMilliseconds(const Workers& workers) {
  return 100.0 * static_cast<double>(std::max<std::size_t>(1, workers.count() - 1));
}

TEST_P(OfThreads, whoWaitsLongForTheOthersSleeps) {
  Workers workers(GetParam());
  const auto before = processorTime();
  workers.forEach(workers.count(), 1, [&](std::size_t, std::size_t i) {
    if (i == 0) std::this_thread::sleep_for(kLongWait);
  });
  EXPECT_LT((processorTime() - before).count(), maxMilliseconds(workers));
}

INSTANTIATE_TEST_SUITE_P(Workers, OfThreads, ::testing::Values(1, 2, 5),
                         [](const auto& threads) { return std::to_string(threads.param); });

}  // namespace
}  // namespace qtet
