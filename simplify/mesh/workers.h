// A few threads that wait for the next piece of work: for loops too short to start threads for.
#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "simplify/mesh/stopping.h"

namespace qtet {

/// As many of the threads that were asked for as the machine runs at once. More would wait for one
/// another, ten times as long with 256 on two cores.
[[nodiscard]] int threadsAtOnce(int asked);

class Workers {
 public:
  /// `threads` >= 1, the caller's included; fewer where the system gives no more. Once a stop is
  /// asked for, forEach and forRuns throw Stopped (stopping.h).
  explicit Workers(int threads, std::stop_token stop = {});
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// For callers whose work between two calls takes long.
  void throwIfStopped() const { qtet::throwIfStopped(stop_); }

  [[nodiscard]] std::size_t count() const { return threads_.size() + 1; }

  /// Calls work(worker, i) for every i below `n`, each once, `grain` neighbours at a time; workers
  /// are numbered 0..count()-1. Returns when all are done. The work's result must not depend on the
  /// worker. An exception of work's is thrown on, after the others have ended.
  void forEach(std::size_t n, std::size_t grain,
               const std::function<void(std::size_t worker, std::size_t i)>& work);

  /// The same for runs of at most `grain` neighbours: work(begin, end).
  void forRuns(std::size_t n, std::size_t grain,
               const std::function<void(std::size_t begin, std::size_t end)>& work) {
    assert(grain > 0);
    forEach((n + grain - 1) / grain, 1, [&](std::size_t, std::size_t run) {
      work(run * grain, std::min(n, (run + 1) * grain));
    });
  }

 private:
  struct Job;
  void runByAll(const std::function<void(std::size_t worker)>& take);
  void awaitOthers();
  void serve(std::size_t worker);
  [[nodiscard]] Job* next(std::size_t& seen);

  std::mutex mutex_;
  std::condition_variable changed_;
  Job* job_ = nullptr;
  std::atomic<std::size_t> jobs_{0}, busy_{0};
  bool ending_ = false;
  std::vector<std::thread> threads_;
  std::stop_token stop_;
};

/// Workers::forEach, or the same by the caller alone where there are no workers.
void forEach(Workers* workers, std::size_t n, std::size_t grain,
             const std::function<void(std::size_t worker, std::size_t i)>& work);

}  // namespace qtet
