#include "simplify/mesh/workers.h"

#include <algorithm>
#include <cassert>
#include <exception>
#include <new>
#include <system_error>
#include <utility>

namespace qtet {
namespace {

using Clock = std::chrono::steady_clock;

// How long a thread looks before it sleeps: about as long as being woken takes, and more than the
// pause between two jobs. A time and no count, since processors' pauses take 5 to 75 ns.
constexpr std::chrono::microseconds kMoment{50};
// Looks between two looks at the clock, which takes as long as some pauses.
constexpr int kLooksAClock = 16;

inline void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Looks until it is done, or for a moment.
template <class Done>
void spinUntil(const Done& done) {
  const Clock::time_point end = Clock::now() + kMoment;
  do {
    for (int look = 0; look < kLooksAClock; ++look) {
      if (done()) return;
      pause();
    }
  } while (Clock::now() < end);
}

}  // namespace

int threadsAtOnce(int asked) {
  return std::min(asked, std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
}

struct Workers::Job {
  const std::function<void(std::size_t)>& take;
  std::exception_ptr failure;  // under the mutex
};

Workers::Workers(int threads, std::stop_token stop) : stop_(std::move(stop)) {
  threads_.reserve(static_cast<std::size_t>(std::max(threads, 1) - 1));
  try {
    for (int i = 1; i < threads; ++i)
      threads_.emplace_back([this, i] { serve(static_cast<std::size_t>(i)); });
  } catch (const std::system_error&) {
    // The result does not depend on how many there are.
  } catch (const std::bad_alloc&) {  // and those that run already could not be left alone
  }
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  for (std::thread& t : threads_) t.join();
}

// Calls take(worker) here and in each worker that comes before it has ended here, and returns when
// all have ended. An exception is thrown on then.
void Workers::runByAll(const std::function<void(std::size_t)>& take) {
  Job job{take, {}};
  {
    const std::lock_guard lock(mutex_);
    assert(job_ == nullptr && !ending_);
    job_ = &job;
    ++jobs_;
  }
  changed_.notify_all();
  std::exception_ptr failure;
  try {
    take(0);
  } catch (...) {
    failure = std::current_exception();
  }
  {
    const std::lock_guard lock(mutex_);
    job_ = nullptr;  // who has not come by now need not be waited for
  }
  awaitOthers();
  if (failure) std::rethrow_exception(failure);
  if (job.failure) std::rethrow_exception(job.failure);
}

void Workers::awaitOthers() {
  spinUntil([this] { return busy_ == 0; });
  for (std::size_t busy = busy_; busy > 0; busy = busy_) busy_.wait(busy);
}

void Workers::forEach(std::size_t n, std::size_t grain,
                      const std::function<void(std::size_t, std::size_t)>& work) {
  assert(grain > 0);
  if (threads_.empty() || n <= grain) {
    for (std::size_t first = 0; first < n; first += grain) {
      throwIfStopped();
      for (std::size_t i = first; i < std::min(n, first + grain); ++i) work(0, i);
    }
    return;
  }
  std::atomic<std::size_t> next{0};
  const auto take = [&](std::size_t worker) {
    try {
      for (std::size_t first = next.fetch_add(grain); first < n; first = next.fetch_add(grain)) {
        throwIfStopped();
        for (std::size_t i = first; i < std::min(n, first + grain); ++i) work(worker, i);
      }
    } catch (...) {
      next = n;
      throw;
    }
  };
  runByAll(take);
}

void forEach(Workers* workers, std::size_t n, std::size_t grain,
             const std::function<void(std::size_t, std::size_t)>& work) {
  if (workers) return workers->forEach(n, grain, work);
  for (std::size_t i = 0; i < n; ++i) work(0, i);
}

/// The next job after the first `seen`, the caller counted as busy with it; null when there will be
/// none.
Workers::Job* Workers::next(std::size_t& seen) {
  for (;;) {
    spinUntil([&] { return jobs_ != seen; });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ending_ || jobs_ != seen; });
    if (ending_) return nullptr;
    seen = jobs_;
    if (job_ == nullptr) continue;  // over already
    ++busy_;
    return job_;
  }
}

void Workers::serve(std::size_t worker) {
  std::size_t seen = 0;
  while (Job* job = next(seen)) {
    try {
      job->take(worker);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!job->failure) job->failure = std::current_exception();
    }
    assert(busy_ > 0 && worker > 0);
    if (--busy_ == 0) busy_.notify_one();
  }
}

}  // namespace qtet
