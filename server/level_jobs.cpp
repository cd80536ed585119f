#include "server/level_jobs.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace qtet {
namespace {

struct Job {
  LevelRequest request;
  std::string key;
  std::stop_source stop;
  std::map<std::uint64_t, LevelJobs::Done> wishes;
};
using JobPointer = std::shared_ptr<Job>;

}  // namespace

// A `done` owns whatever waits for it and may take the lock when it goes, so none is destroyed while the lock is held.
struct LevelJobs::State {
  explicit State(Options given) : options(std::move(given)) {}

  Options options;
  mutable std::mutex mutex;
  std::condition_variable news;
  bool ending = false;
  std::uint64_t nextWish = 0;
  std::map<std::string, JobPointer> jobs;  // wanted by somebody, waiting or running
  std::deque<JobPointer> waiting;
  std::vector<JobPointer> running;
  LevelJobCounts counts;
  std::vector<std::jthread> threads;

  void work();
  void finish(const JobPointer& job, Result<Bytes> bytes);
  void withdraw(const JobPointer& job, std::uint64_t wish);
};

void LevelJobs::State::work() {
  for (;;) {
    JobPointer job;
    {
      std::unique_lock lock(mutex);
      news.wait(lock, [this] { return ending || !waiting.empty(); });
      if (ending) return;
      job = waiting.front();
      waiting.pop_front();
      running.push_back(job);
    }
    finish(job, options.maker(job->request, job->stop.get_token()));
  }
}

void LevelJobs::State::finish(const JobPointer& job, Result<Bytes> bytes) {
  Result<LevelFile> file = std::unexpected(Error{});
  if (!bytes) {
    file = std::unexpected(bytes.error());
  } else if (options.cache != nullptr && !job->stop.stop_requested()) {
    file = options.cache->put(job->key, std::move(*bytes));
  } else {
    const auto owner = std::make_shared<const Bytes>(std::move(*bytes));
    file = LevelFile{*owner, owner};
  }
  std::map<std::uint64_t, Done> wishes;
  {
    const std::scoped_lock lock(mutex);
    std::erase(running, job);
    if (const auto it = jobs.find(job->key); it != jobs.end() && it->second == job) jobs.erase(it);
    if (!job->stop.stop_requested()) ++(file ? counts.made : counts.failed);
    if (!ending) wishes = std::exchange(job->wishes, {});
  }
  for (auto& [number, done] : wishes) done(file);
}

void LevelJobs::State::withdraw(const JobPointer& job, std::uint64_t wish) {
  Done gone;
  const std::scoped_lock lock(mutex);
  const auto it = job->wishes.find(wish);
  if (it == job->wishes.end()) return;  // answered
  gone = std::move(it->second);
  job->wishes.erase(it);
  if (!job->wishes.empty()) return;
  ++counts.cancelled;
  job->stop.request_stop();
  jobs.erase(job->key);
  std::erase(waiting, job);
}

LevelJobs::Wish& LevelJobs::Wish::operator=(Wish&& other) noexcept {
  std::swap(withdraw_, other.withdraw_);
  return *this;
}

LevelJobs::Wish::~Wish() {
  if (withdraw_) withdraw_();
}

LevelJobs::LevelJobs(Options options) : state_(std::make_shared<State>(std::move(options))) {
  for (std::size_t i = 0; i < state_->options.threads; ++i) state_->threads.emplace_back([state = state_.get()] { state->work(); });
}

LevelJobs::~LevelJobs() {
  std::map<std::string, JobPointer> dropped;
  {
    const std::scoped_lock lock(state_->mutex);
    state_->ending = true;
    state_->waiting.clear();
    dropped = std::exchange(state_->jobs, {});
    for (const JobPointer& job : state_->running) job->stop.request_stop();
  }
  state_->news.notify_all();
  state_->threads.clear();
  for (const auto& [key, job] : dropped) {
    std::map<std::uint64_t, Done> wishes;
    const std::scoped_lock lock(state_->mutex);
    wishes = std::exchange(job->wishes, {});
  }
}

std::optional<LevelFile> LevelJobs::find(const LevelRequest& request) {
  if (state_->options.cache == nullptr) return std::nullopt;
  std::optional<LevelFile> out = state_->options.cache->find(request.key());
  if (out) {
    const std::scoped_lock lock(state_->mutex);
    ++state_->counts.found;
  }
  return out;
}

std::optional<LevelJobs::Wish> LevelJobs::submit(const LevelRequest& request, Done done) {
  std::string key = request.key();
  const std::scoped_lock lock(state_->mutex);
  JobPointer& job = state_->jobs[key];
  if (!job) {
    if (state_->waiting.size() + state_->running.size() >= state_->options.most) {
      ++state_->counts.refused;
      state_->jobs.erase(key);
      return std::nullopt;
    }
    job = std::make_shared<Job>(Job{request, std::move(key), {}, {}});
    state_->waiting.push_back(job);
    state_->news.notify_one();
  }
  const std::uint64_t wish = state_->nextWish++;
  job->wishes.emplace(wish, std::move(done));
  return Wish([weak = std::weak_ptr(state_), job, wish] {
    if (const auto state = weak.lock()) state->withdraw(job, wish);
  });
}

LevelJobCounts LevelJobs::counts() const {
  const std::scoped_lock lock(state_->mutex);
  LevelJobCounts out = state_->counts;
  out.waiting = state_->waiting.size();
  out.running = state_->running.size();
  return out;
}

}  // namespace qtet
