// A check of uploads that a test can hold up.
#pragma once

#include <condition_variable>
#include <mutex>

#include "server/store/log_check.h"

namespace qtet::test {

/// The real check. After a hold, each check first waits until it is released or stopped.
class HeldCheck {
 public:
  CheckVerdict operator()(const ServedMesh& mesh, const CheckLimits& limits,
                          const std::stop_token& stop) {
    {
      const std::stop_callback wake(stop, [this] { changed_.notify_all(); });
      std::unique_lock lock(mutex_);
      // a stop may come between the look and the wait
      while (held_ && !stop.stop_requested())
        changed_.wait_for(lock, std::chrono::milliseconds(20));
      stopped_ += stop.stop_requested();
    }
    return checkLog(mesh, limits, stop);
  }
  void hold(bool held) {
    const std::scoped_lock lock(mutex_);
    held_ = held;
    changed_.notify_all();
  }
  [[nodiscard]] int stopped() {
    const std::scoped_lock lock(mutex_);
    return stopped_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool held_ = false;
  int stopped_ = 0;
};

}  // namespace qtet::test
