#include "simplify/workers.h"

#include <algorithm>
#include <atomic>

namespace qtet {

struct Workers::Job {
  std::size_t n, grain;
  const std::function<void(std::size_t, std::size_t)>& work;
  std::atomic<std::size_t> next{0};
};

Workers::Workers(int threads) {
  for (int i = 1; i < threads; ++i) threads_.emplace_back([this, i] { serve(static_cast<std::size_t>(i)); });
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  for (std::thread& t : threads_) t.join();
}

void Workers::take(Job& job, std::size_t worker) {
  for (std::size_t first = job.next.fetch_add(job.grain); first < job.n; first = job.next.fetch_add(job.grain))
    for (std::size_t i = first; i < std::min(job.n, first + job.grain); ++i) job.work(worker, i);
}

void Workers::forEach(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& work) {
  Job job{n, grain, work};
  if (threads_.empty() || n <= grain) return take(job, 0);
  {
    const std::lock_guard lock(mutex_);
    job_ = &job;
    ++jobs_;
    busy_ = threads_.size();
  }
  changed_.notify_all();
  take(job, 0);
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [&] { return busy_ == 0; });
}

void Workers::serve(std::size_t worker) {
  std::size_t seen = 0;
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ending_ || jobs_ != seen; });
    if (ending_) return;
    seen = jobs_;
    Job& job = *job_;
    lock.unlock();
    take(job, worker);
    lock.lock();
    if (--busy_ == 0) idle_.notify_one();
  }
}

}  // namespace qtet
