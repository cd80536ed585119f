#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/level_jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>
#include <vector>

namespace qtet {
namespace {

TEST(LevelJobs, aLevelIsMadeElsewhere) {
  LevelJobs jobs(1, 1, [](const LevelRequest& request) { return Result<Bytes>(Bytes(request.level, 0x42)); });
  const auto place = jobs.reserve();
  ASSERT_TRUE(place);
  std::promise<std::pair<Result<Bytes>, std::thread::id>> promise;
  jobs.submit({nullptr, 3}, [&](Result<Bytes> bytes) { promise.set_value({std::move(bytes), std::this_thread::get_id()}); });
  const auto [bytes, thread] = promise.get_future().get();
  EXPECT_EQ(*bytes, Bytes(3, 0x42));
  EXPECT_NE(thread, std::this_thread::get_id());
}

TEST(LevelJobs, thereAreAsManyPlacesAsItWasTold) {
  LevelJobs jobs(1, 2, {});
  auto first = jobs.reserve();
  const auto second = jobs.reserve();
  EXPECT_TRUE(first);
  EXPECT_TRUE(second);
  EXPECT_FALSE(jobs.reserve());
  first.reset();
  EXPECT_TRUE(jobs.reserve());
}

TEST(LevelJobs, placesNeverOverflowUnderManyThreads) {
  LevelJobs jobs(1, 3, {});
  std::atomic<int> held = 0;
  std::atomic<bool> tooMany = false;
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 2000; ++i)
        if (const auto place = jobs.reserve()) {
          if (++held > 3) tooMany = true;
          --held;
        }
    });
  threads.clear();
  EXPECT_FALSE(tooMany);
}

TEST(LevelJobs, aPlaceMayOutliveTheJobs) {
  LevelJobs::Place place;
  {
    LevelJobs jobs(1, 1, {});
    place = jobs.reserve();
  }
  EXPECT_TRUE(place);
}

TEST(LevelJobs, waitingJobsAreDroppedAtTheEndAndARunningOneIsWaitedFor) {
  std::promise<void> started;
  std::promise<void> go;
  auto goes = go.get_future().share();
  std::atomic<int> done = 0;
  auto jobs = std::make_unique<LevelJobs>(1, 8, [&, goes](const LevelRequest& request) {
    if (request.level == 0) started.set_value(), goes.wait();
    return Result<Bytes>(Bytes());
  });
  for (std::uint32_t i = 0; i < 5; ++i) jobs->submit({nullptr, i}, [&](const Result<Bytes>&) { ++done; });
  started.get_future().wait();
  std::jthread ending([&] { jobs.reset(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  go.set_value();
  ending.join();
  EXPECT_GE(done, 1);
}

}  // namespace
}  // namespace qtet
