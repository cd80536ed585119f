// A maker of levels that a test can hold up.
#pragma once

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <stop_token>

#include "server/store/level_file.h"
#include "server/store/level_request.h"
#include "tests/server/program/loopback.h"

namespace qtet::test {

/// Makes levels on command, and notices when it is stopped.
class HeldMaker {
 public:
  Result<LevelFile> operator()(const LevelRequest& request, const std::stop_token& stop) {
    const std::stop_callback wake(stop, [this] { changed_.notify_all(); });
    std::unique_lock lock(mutex_);
    ++begun_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return free_ || stop.stop_requested(); });
    if (stop.stop_requested()) ++stopped_;
    changed_.notify_all();
    return inMemory(Bytes(request.level + 1, 0x42));
  }
  void release() {
    const std::scoped_lock lock(mutex_);
    free_ = true;
    changed_.notify_all();
  }
  void waitForBegun(int count) {
    wait([&] { return begun_ >= count; });
  }
  void waitForStopped(int count) {
    wait([&] { return stopped_ >= count; });
  }
  [[nodiscard]] int begun() {
    const std::scoped_lock lock(mutex_);
    return begun_;
  }

 private:
  template <class Condition>
  void wait(Condition condition) {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, kPatience, condition));
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  bool free_ = false;
  int begun_ = 0, stopped_ = 0;
};

}  // namespace qtet::test
