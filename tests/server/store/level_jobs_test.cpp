#include "server/store/level_jobs.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <future>
#include <latch>
#include <thread>
#include <vector>

#include "server/store/kept_points.h"
#include "server/store/level_cache.h"
#include "tests/server/program/loopback.h"
#include "tests/server/program/served_folder.h"
#include "tests/server/store/held_maker.h"

namespace qtet {
namespace {

class LevelJobsTest : public ::testing::Test {
 protected:
  ~LevelJobsTest() override { maker_.release(); }
  LevelRequest level(std::uint32_t k) { return {folder_.store().find("noise"), k}; }
  LevelJobs::Options options(std::size_t most) { return {1, most, nullptr, std::ref(maker_)}; }

  test::ServedFolder folder_;
  test::HeldMaker maker_;
};

TEST_F(LevelJobsTest, aLevelIsMadeElsewhere) {
  maker_.release();
  LevelJobs jobs(options(1));
  std::promise<std::pair<std::size_t, std::thread::id>> promise;
  const auto subscription = jobs.submit(level(3), [&](Result<LevelFile> file) {
    promise.set_value({file->bytes.size(), std::this_thread::get_id()});
  });
  ASSERT_TRUE(subscription);
  const auto [bytes, thread] = promise.get_future().get();
  EXPECT_EQ(bytes, 4u);
  EXPECT_NE(thread, std::this_thread::get_id());
}

TEST_F(LevelJobsTest, whoWantsTheSameSharesTheJob) {
  LevelJobs jobs(options(1));
  std::atomic<int> done = 0;
  std::vector<LevelJobs::Subscription> subscribers;
  std::promise<void> last;
  for (int i = 0; i < 5; ++i) {
    auto subscription = jobs.submit(level(3), [&](const Result<LevelFile>& file) {
      EXPECT_EQ(file->bytes.size(), 4u);
      if (++done == 5) last.set_value();
    });
    ASSERT_TRUE(subscription);
    subscribers.push_back(std::move(*subscription));
  }
  maker_.release();
  last.get_future().wait();
  EXPECT_EQ(maker_.begun(), 1);
  EXPECT_EQ(jobs.counts().made, 1u);
}

TEST_F(LevelJobsTest, thereAreAsManyJobsAsItWasTold) {
  LevelJobs jobs(options(2));
  const auto first = jobs.submit(level(0), [](const Result<LevelFile>&) {});
  maker_.waitForBegun(1);
  std::optional second = jobs.submit(level(1), [](const Result<LevelFile>&) {});
  EXPECT_TRUE(first && *second);
  EXPECT_EQ(jobs.submit(level(2), [](const Result<LevelFile>&) {}).error(), LevelRefusal::kBusy);
  EXPECT_TRUE(jobs.submit(level(1), [](const Result<LevelFile>&) {}))
      << "a subscription for a job that is there needs no place";
  EXPECT_EQ(jobs.counts().refused, 1u);
  second.reset();
  EXPECT_TRUE(jobs.submit(level(2), [](const Result<LevelFile>&) {}))
      << "a job that waits and nobody wants gives its place back";
}

TEST_F(LevelJobsTest, anAddressHasAsManyAsItMayHaveAndOthersHaveTheirs) {
  const int one = 0, other = 0;
  LevelJobs::Options few = options(4);
  few.maxOfAddress = 2;
  LevelJobs jobs(few);
  const auto submit = [&](std::uint32_t k, LevelJobs::Address from) {
    return jobs.submit(level(k), [](const Result<LevelFile>&) {}, from);
  };
  auto first = submit(0, &one), again = submit(0, &one), second = submit(1, &one);
  EXPECT_TRUE(first && again && second) << "twice the same is one job";
  EXPECT_EQ(submit(2, &one).error(), LevelRefusal::kAddress);
  const auto theirs = submit(2, &other);
  ASSERT_TRUE(theirs);
  EXPECT_TRUE(submit(2, &one)) << "somebody else's job takes no place of this address's";
  {
    const LevelJobs::Subscription gone = std::move(*second);
  }
  EXPECT_TRUE(submit(3, &one)) << "a subscription that has gone gives its place back";
  EXPECT_TRUE(submit(3, nullptr)) << "who is from nowhere is not bounded";
  EXPECT_EQ(jobs.counts().refused, 1u);
}

TEST_F(LevelJobsTest, withTheLastSubscriptionTheJobEnds) {
  LevelJobs jobs(options(1));
  std::optional first =
      jobs.submit(level(0), [](const Result<LevelFile>&) { ADD_FAILURE() << "nobody waits"; });
  std::optional second =
      jobs.submit(level(0), [](const Result<LevelFile>&) { ADD_FAILURE() << "nobody waits"; });
  maker_.waitForBegun(1);
  first.reset();
  EXPECT_EQ(jobs.counts().cancelled, 0u);
  second.reset();
  maker_.waitForStopped(1);
  EXPECT_EQ(jobs.counts().cancelled, 1u);
}

TEST_F(LevelJobsTest, aSubscriptionMayOutliveTheJobs) {
  std::optional<LevelJobs::Subscription> subscription;
  {
    LevelJobs jobs(options(1));
    auto submitted = jobs.submit(level(0), [](const Result<LevelFile>&) {});
    ASSERT_TRUE(submitted);
    subscription = std::move(*submitted);
  }
  subscription.reset();
}

TEST_F(LevelJobsTest, atTheEndWhatWaitsIsDroppedAndWhatRunsIsStopped) {
  std::vector<LevelJobs::Subscription> subscribers;
  {
    LevelJobs jobs(options(8));
    for (std::uint32_t i = 0; i < 5; ++i)
      subscribers.push_back(std::move(*jobs.submit(level(i), [](const Result<LevelFile>&) {})));
    maker_.waitForBegun(1);
  }
  EXPECT_EQ(maker_.begun(), 1);
}

TEST_F(LevelJobsTest, finishedLevelsAreKeptOnDiskUpToALimit) {
  maker_.release();
  test::TempFolder folder;
  {
    const auto cache = LevelCache::open(folder.path() / "levels", 10);
    ASSERT_TRUE(cache);
    LevelJobs jobs({1, 8, cache->get(), std::ref(maker_)});
    for (const std::uint32_t k : {3u, 4u, 5u, 11u}) {  // 4, 5, 6 and 12 bytes
      std::promise<std::size_t> bytes;
      const auto subscription = jobs.submit(
          level(k), [&](Result<LevelFile> file) { bytes.set_value(file->bytes.size()); });
      EXPECT_EQ(bytes.get_future().get(), k + 1);
      if (k == 4) {
        EXPECT_TRUE(jobs.find(level(3))) << "used again, so 4 is the older one";
      }
    }
    EXPECT_TRUE(jobs.find(level(3)));
    EXPECT_FALSE(jobs.find(level(4)));
    EXPECT_TRUE(jobs.find(level(5)));
    EXPECT_FALSE(jobs.find(level(11))) << "alone above the limit";
    EXPECT_EQ((*cache)->bytes(), 10u);
  }
  const auto again = LevelCache::open(folder.path() / "levels", 10);
  ASSERT_TRUE(again);
  const auto found = (*again)->find(level(5).key());
  ASSERT_TRUE(found) << "a later run finds them";
  EXPECT_EQ((*found)->bytes.size(), 6u);
  std::filesystem::resize_file(folder.path() / "levels" / (level(3).key() + ".level"), 1);
  EXPECT_FALSE((*again)->find(level(3).key())) << "not the file that was put there";
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "levels" / (level(3).key() + ".level")))
      << "what is not counted does not lie there";
}

TEST(LevelCache, whatAKilledServerDidNotFinishGoesAndWhatAnotherOneWritesStays) {
  const test::TempFolder folder;
  const std::string key(64, 'a'), unfinished = "." + key + ".level.12.0.tmp",
                                  written = "." + key + ".level.13.0.tmp";
  const std::vector<std::string> others = {".a.level.12.0.tmp", "." + key + ".level.12.tmp",
                                           "." + key + ".12.0.tmp", key + ".level.12.0.tmp"};
  for (const std::string& name : others) folder.write(name, std::string_view("somebody's"));
  for (const std::string& name : {unfinished, written})
    folder.write(name, std::string_view("half"));
  const int lock = ::open((folder.path() / written).c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  ASSERT_TRUE(LevelCache::open(folder.path(), 10));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / unfinished));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / written));
  for (const std::string& name : others)
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name)) << name;
  ::close(lock);
}

TEST(LevelCache, aDamagedLevelIsNoticedAndMadeAnew) {
  const test::TempFolder folder;
  const std::string key(64, 'b');
  const Bytes level = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const std::filesystem::path file = folder.path() / (key + ".level");
  const auto damages = std::vector<std::function<void()>>{
      [&] {
        std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(3).put('x');
        // later than the clock's last tick
        std::filesystem::last_write_time(
            file, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(1));
      },
      [&] { std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1); },
      [&] { std::filesystem::resize_file(file, std::filesystem::file_size(file) + 1); },
      [&] { std::filesystem::resize_file(file, 3); },
      [&] {
        folder.write(key + ".level", ByteView(level));
      }};  // as a cache without checksums has it
  for (const bool restarted : {false, true})
    for (std::size_t i = 0; i < damages.size(); ++i) {
      auto cache = LevelCache::open(folder.path(), 100);
      ASSERT_TRUE(cache);
      EXPECT_TRUE(std::ranges::equal((*cache)->put(key, inMemory(level))->bytes, level));
      EXPECT_TRUE((*cache)->find(key));
      damages[i]();
      if (restarted) cache = LevelCache::open(folder.path(), 100);
      EXPECT_FALSE((*cache)->find(key)) << i;
      EXPECT_FALSE(std::filesystem::exists(file)) << i;
      EXPECT_EQ((*cache)->bytes(), 0u) << i;
    }
}

TEST(LevelCache, theLevelsUsedLastAreAtHandUntilTheirFilesChange) {
  const test::TempFolder folder;
  const auto keyOf = [](std::size_t number) {
    const std::string digits = std::to_string(number);
    return digits + std::string(64 - digits.size(), 'a');
  };
  const Bytes level(3, 7);
  const auto cache = LevelCache::open(folder.path(), 1'000'000, 0);
  for (std::size_t i = 0; i <= limits::kMaxOpenLevels; ++i)
    ASSERT_TRUE((*cache)->put(keyOf(i), inMemory(level)));
  EXPECT_FALSE((*cache)->atHand(keyOf(0)));
  EXPECT_TRUE((*cache)->atHand(keyOf(1)));
  EXPECT_TRUE((*cache)->has(keyOf(0)));
  EXPECT_TRUE((*cache)->find(keyOf(0)));
  const KeptAnswer opened = (*cache)->atHand(keyOf(0));
  ASSERT_TRUE(opened);
  EXPECT_TRUE(std::ranges::equal((*opened)->bytes, level));
  EXPECT_FALSE((*cache)->atHand(keyOf(2))) << "the least recently used went";

  std::filesystem::last_write_time(
      folder.path() / (keyOf(0) + ".level"),
      std::filesystem::file_time_type::clock::now() + std::chrono::seconds(1));
  EXPECT_FALSE((*cache)->atHand(keyOf(0))) << "it may be another one";
  EXPECT_TRUE((*cache)->find(keyOf(0))) << "it is not";
  EXPECT_FALSE((*cache)->has(keyOf(limits::kMaxOpenLevels + 1)));
  const Error error{ErrorCode::kIo, "", 0};
  EXPECT_FALSE((*cache)->put(keyOf(999), std::unexpected(error)));
  EXPECT_FALSE((*cache)->has(keyOf(999)));
}

TEST(KeptPoints, keepsSoManyAnswersAndSoManyBytesAndThatAPointIsOutside) {
  const auto put = [](KeptPoints& points, const std::string& key, std::size_t bytes) {
    (void)points.put(key, inMemory(Bytes(bytes, 1)));
  };
  KeptPoints few(2), small(100, 3 * (2 + 10));
  for (const char* key : {"a", "b", "c"}) put(few, key, 10), put(small, key, 10);
  EXPECT_FALSE(few.has("a"));
  EXPECT_TRUE(few.atHand("b"));
  EXPECT_TRUE(small.has("a")) << "just as many bytes as may be";
  put(small, "d", 10);
  EXPECT_FALSE(small.has("a"));
  put(small, "large", 27);  // with twice its key one too many
  EXPECT_FALSE(small.has("large"));
  EXPECT_TRUE(small.has("d"));
  put(few, "d", 10);
  EXPECT_FALSE(few.has("c")) << "b was used since";

  const auto answer = [](ErrorCode code) {
    return Result<LevelFile>(std::unexpected(Error{code, "outside", Error::kNoOffset}));
  };
  EXPECT_FALSE(few.put("outside", answer(ErrorCode::kNotFound)));
  EXPECT_FALSE(few.put("io", answer(ErrorCode::kIo)));
  const KeptAnswer outside = few.atHand("outside");
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->error().message, "outside");
  EXPECT_FALSE(few.has("io"));
}

TEST(LevelCache, aDiskWithTooLittleLeftKeepsNothing) {
  const test::TempFolder folder;
  std::uintmax_t left = 0;
  const auto cache =
      LevelCache::open(folder.path(), 100, 50, [&](const std::filesystem::path&) { return left; });
  const std::string key(64, 'c');
  const Bytes level(10, 1);
  EXPECT_TRUE(std::ranges::equal((*cache)->put(key, inMemory(level))->bytes, level))
      << "from memory";
  EXPECT_FALSE((*cache)->find(key));
  constexpr std::uintmax_t kNeeded = 50 + 10 + 8;  // the reserve, the level, its seal
  for (const std::uintmax_t bytes : {kNeeded - 1, kNeeded, kNeeded + 1}) {
    left = bytes;
    const std::string own(64, static_cast<char>('0' + bytes - kNeeded + 1));
    EXPECT_TRUE(std::ranges::equal((*cache)->put(own, inMemory(level))->bytes, level));
    EXPECT_EQ((*cache)->find(own).has_value(), bytes >= kNeeded) << bytes;
  }
}

TEST(LevelCache, keepsNoMoreLevelsThanItMay) {
  for (const std::size_t most : {2u, 3u, 4u}) {
    const test::TempFolder folder;
    const auto keyOf = [](char c) { return std::string(64, c); };
    const auto cache =
        LevelCache::open(folder.path(), 1000, 0, [](const auto&) { return 1u << 30; }, most);
    for (const char c : std::string("abc")) (void)(*cache)->put(keyOf(c), inMemory(Bytes(10, 1)));
    EXPECT_EQ((*cache)->find(keyOf('a')).has_value(), most >= 3) << most;
    EXPECT_TRUE((*cache)->find(keyOf('b'))) << most;
    EXPECT_EQ((*cache)->bytes(), 10 * std::min<std::size_t>(most, 3));
  }
}

TEST(LevelCache, afterARestartTheLeastRecentlyUsedStillGoesFirst) {
  const test::TempFolder folder;
  const std::string byAge = "2b7a05";  // the oldest first, in no order of names
  const auto keyOf = [](char c) { return std::string(64, c); };
  const auto fileOf = [&](char c) { return folder.path() / (keyOf(c) + ".level"); };
  {
    const auto cache = LevelCache::open(folder.path(), 60);
    for (const char c : std::string("05ba27"))
      (void)(*cache)->put(keyOf(c), inMemory(Bytes(10, 1)));
  }
  const auto hourAgo = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  for (std::size_t age = 0; age < byAge.size(); ++age)
    std::filesystem::last_write_time(fileOf(byAge[age]), hourAgo + std::chrono::seconds(age));
  const auto expectKept = [&](std::size_t gone) {
    for (std::size_t age = 0; age < byAge.size(); ++age)
      EXPECT_EQ(std::filesystem::exists(fileOf(byAge[age])), age >= gone) << gone << ", " << age;
  };
  auto cache = LevelCache::open(folder.path(), 60);
  expectKept(0);
  cache = LevelCache::open(folder.path(), 59);
  expectKept(1);
  for (const char next : {'c', 'd'}) (void)(*cache)->put(keyOf(next), inMemory(Bytes(10, 1)));
  expectKept(3);
  EXPECT_TRUE((*cache)->find(keyOf(byAge[3])));
  (void)(*cache)->put(keyOf('e'), inMemory(Bytes(10, 1)));
  EXPECT_TRUE(std::filesystem::exists(fileOf(byAge[3]))) << "used since";
  EXPECT_FALSE(std::filesystem::exists(fileOf(byAge[4])));
  EXPECT_TRUE((*cache)->find(keyOf(byAge[5])));
  cache = LevelCache::open(folder.path(), 10);
  EXPECT_TRUE((*cache)->find(keyOf(byAge[5]))) << "used last";
  EXPECT_EQ((*cache)->bytes(), 10u);
}

TEST_F(LevelJobsTest, addressesTakeTurns) {
  const int one = 0, two = 0, three = 0;
  std::mutex mutex;
  std::vector<std::uint32_t> made;
  LevelJobs::Options turns = options(20);
  turns.maker = [&](const LevelRequest& request, const std::stop_token& stop) {
    Result<LevelFile> out = maker_(request, stop);
    const std::scoped_lock lock(mutex);
    made.push_back(request.level);
    return out;
  };
  std::vector<LevelJobs::Subscription> wanted;
  std::latch all(8);
  LevelJobs jobs(turns);
  const auto want = [&](std::uint32_t k, LevelJobs::Address from) {
    wanted.push_back(
        *jobs.submit(level(k), [&](const Result<LevelFile>&) { all.count_down(); }, from));
  };
  want(0, &one);
  maker_.waitForBegun(1);
  for (const std::uint32_t k : {1u, 2u, 3u}) want(k, &one);
  for (const std::uint32_t k : {4u, 5u, 6u}) want(k, &two);
  want(7, &three);
  maker_.release();
  all.wait();
  EXPECT_EQ(made, (std::vector<std::uint32_t>{0, 4, 7, 1, 5, 2, 6, 3}));
}

TEST(LevelCache, aFolderThatCannotBeIsAnError) {
  EXPECT_EQ(LevelCache::open("/proc/nothing", 1).error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace qtet
