#include "server/store/level_jobs.h"

#include <algorithm>
#include <cassert>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace qtet {
namespace {

struct Wanted {
  LevelJobs::Done done;
  LevelJobs::Address from = nullptr;
};
using Subscribers = std::map<std::uint64_t, Wanted>;

struct Job {
  LevelRequest request;
  std::string key;
  std::stop_source stop;
  Subscribers subscribers;
};
using JobPointer = std::shared_ptr<Job>;

}  // namespace

// A `done` owns its waiting client and may take the lock in its destructor, so none is destroyed
// while the lock is held.
struct LevelJobs::State {
  explicit State(Options given) : options(std::move(given)) {}

  Options options;
  mutable std::mutex mutex;
  std::condition_variable news;
  bool ending = false;
  std::uint64_t nextSubscription = 0;
  std::map<std::string, JobPointer> jobs;  // wanted by somebody, waiting or running
  std::deque<JobPointer> waiting;
  /// When a job last began that this address wanted, counted in jobs; of those that wait alone.
  std::map<Address, std::uint64_t> turns;
  std::uint64_t begun = 0;
  std::vector<JobPointer> running;
  LevelJobCounts counts;
  std::vector<std::jthread> threads;

  /// Until the end.
  void work();
  bool workOnce(bool waits);
  void finish(const JobPointer& job);
  /// The first job of the address that has waited longest since one of its own began. REQUIRES:
  /// mutex is held, and some job waits.
  [[nodiscard]] JobPointer takeNext();
  void withdraw(const JobPointer& job, std::uint64_t subscription);
  /// Why there is no place for another job. REQUIRES: mutex is held.
  [[nodiscard]] std::optional<LevelRefusal> refusalOf(Address from) const;
};

void LevelJobs::State::work() {
  while (workOnce(true)) {
  }
}

/// False: the jobs end; or none waits, and the caller does not.
bool LevelJobs::State::workOnce(bool waits) {
  JobPointer job;
  {
    std::unique_lock lock(mutex);
    if (waits) news.wait(lock, [this] { return ending || !waiting.empty(); });
    if (ending || waiting.empty()) return false;
    job = takeNext();
    running.push_back(job);
  }
  finish(job);
  return true;
}

JobPointer LevelJobs::State::takeNext() {
  assert(!waiting.empty());
  // an address that wants nothing may have gone, and another one lie in its place
  std::erase_if(turns, [this](const auto& entry) {
    return std::ranges::none_of(waiting, [&](const JobPointer& job) {
      return std::ranges::any_of(job->subscribers, [&](const auto& subscription) {
        return subscription.second.from == entry.first;
      });
    });
  });
  const auto turnOf = [this](const JobPointer& job) {
    std::uint64_t out = ~std::uint64_t{0};
    for (const auto& [number, wanted] : job->subscribers) {
      const auto turn = turns.find(wanted.from);
      out = std::min(out, turn == turns.end() ? 0 : turn->second);
    }
    return out;
  };
  const auto next = std::ranges::min_element(waiting, {}, turnOf);  // the first of equals
  JobPointer out = *next;
  waiting.erase(next);
  ++begun;
  for (const auto& [number, wanted] : out->subscribers) turns[wanted.from] = begun;
  return out;
}

void LevelJobs::State::finish(const JobPointer& job) {
  KeptAnswer kept = options.kept != nullptr ? options.kept->find(job->key) : std::nullopt;
  const bool found = kept.has_value();
  Result<LevelFile> file =
      found ? std::move(*kept) : options.maker(job->request, job->stop.get_token());
  if (!found && options.kept != nullptr && !job->stop.stop_requested())
    file = options.kept->put(job->key, std::move(file));
  Subscribers subscribers;
  {
    const std::scoped_lock lock(mutex);
    std::erase(running, job);
    if (const auto it = jobs.find(job->key); it != jobs.end() && it->second == job) jobs.erase(it);
    // a point outside the mesh, or numbers that a kind of file does not know, are no failures
    const bool isAnswer = file || file.error().code == ErrorCode::kNotFound ||
                          file.error().code == ErrorCode::kBadInput;
    if (!job->stop.stop_requested())
      ++(found ? counts.found : isAnswer ? counts.made : counts.failed);
    if (!ending) subscribers = std::exchange(job->subscribers, {});
  }
  for (auto& [number, subscription] : subscribers) subscription.done(file);
}

void LevelJobs::State::withdraw(const JobPointer& job, std::uint64_t subscription) {
  Done gone;
  const std::scoped_lock lock(mutex);
  const auto it = job->subscribers.find(subscription);
  if (it == job->subscribers.end()) return;  // answered
  gone = std::move(it->second.done);
  job->subscribers.erase(it);
  if (!job->subscribers.empty()) return;
  assert(ending || (jobs.contains(job->key) && jobs.at(job->key) == job));
  ++counts.cancelled;
  job->stop.request_stop();
  jobs.erase(job->key);
  std::erase(waiting, job);
}

std::optional<LevelRefusal> LevelJobs::State::refusalOf(Address from) const {
  if (waiting.size() + running.size() >= options.most) return LevelRefusal::kBusy;
  if (from == nullptr || options.maxOfAddress == 0) return std::nullopt;
  const auto wants = [from](const auto& entry) {
    return std::ranges::any_of(entry.second->subscribers, [from](const auto& subscription) {
      return subscription.second.from == from;
    });
  };
  if (static_cast<std::size_t>(std::ranges::count_if(jobs, wants)) >= options.maxOfAddress)
    return LevelRefusal::kAddress;
  return std::nullopt;
}

LevelJobs::Subscription& LevelJobs::Subscription::operator=(Subscription&& other) noexcept {
  std::swap(withdraw_, other.withdraw_);
  return *this;
}

LevelJobs::Subscription::~Subscription() {
  if (withdraw_) withdraw_();
}

LevelJobs::LevelJobs(Options options) : state_(std::make_shared<State>(std::move(options))) {
  for (std::size_t i = 0; i < state_->options.threads; ++i)
    state_->threads.emplace_back([state = state_.get()] { state->work(); });
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
    Subscribers subscribers;
    const std::scoped_lock lock(state_->mutex);
    subscribers = std::exchange(job->subscribers, {});
  }
}

KeptAnswer LevelJobs::find(const LevelRequest& request) {
  if (state_->options.kept == nullptr) return std::nullopt;
  KeptAnswer out = state_->options.kept->atHand(request.key());
  if (out) {
    const std::scoped_lock lock(state_->mutex);
    ++state_->counts.found;
  }
  return out;
}

bool LevelJobs::keeps(const LevelRequest& request) const {
  return state_->options.kept != nullptr && state_->options.kept->has(request.key());
}

std::expected<LevelJobs::Subscription, LevelRefusal> LevelJobs::submit(const LevelRequest& request,
                                                                       Done done, Address from) {
  assert(request.mesh && done);
  std::string key = request.key();
  const std::scoped_lock lock(state_->mutex);
  if (!state_->jobs.contains(key)) {
    if (const std::optional<LevelRefusal> refusal = state_->refusalOf(from)) {
      ++state_->counts.refused;
      return std::unexpected(*refusal);
    }
  }
  JobPointer& job = state_->jobs[key];
  if (!job) {
    job = std::make_shared<Job>(Job{request, std::move(key), {}, {}});
    state_->waiting.push_back(job);
    state_->news.notify_one();
  }
  const std::uint64_t subscription = state_->nextSubscription++;
  job->subscribers.emplace(subscription, Wanted{std::move(done), from});
  return Subscription([weak = std::weak_ptr(state_), job, subscription] {
    if (const auto state = weak.lock()) state->withdraw(job, subscription);
  });
}

bool LevelJobs::workOnce() { return state_->workOnce(false); }

LevelJobCounts LevelJobs::counts() const {
  const std::scoped_lock lock(state_->mutex);
  LevelJobCounts out = state_->counts;
  out.waiting = state_->waiting.size();
  out.running = state_->running.size();
  for (const auto& [key, job] : state_->jobs) out.wanted += job->subscribers.size();
  return out;
}

}  // namespace qtet
