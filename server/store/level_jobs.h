// Makes levels on threads of their own, a few at a time. All clients of the same level share one
// job, which ends when nobody wants it any more.
#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "server/store/kept_answers.h"
#include "server/store/level_request.h"

namespace qtet {

struct LevelJobCounts {
  std::size_t waiting = 0;  ///< jobs that have not begun
  std::size_t running = 0;
  std::size_t wanted = 0;  ///< subscribers that are not answered
  std::uint64_t made = 0, found = 0, cancelled = 0, refused = 0, failed = 0;  ///< since the start

  LevelJobCounts& operator+=(const LevelJobCounts& other) {
    waiting += other.waiting, running += other.running, wanted += other.wanted;
    made += other.made, found += other.found, cancelled += other.cancelled;
    refused += other.refused, failed += other.failed;
    return *this;
  }
};

enum class LevelRefusal : std::uint8_t {
  kBusy,     ///< there are as many jobs as there may be
  kAddress,  ///< the address wants as many as it may
  /// The client closed; the job ends if nobody else wants it. A client that only closes its sending
  /// half counts as gone.
  kGone,
};

/// Thread-safe: a mutex guards the queue; makers and `done` run without it. Addresses take turns: a
/// job of one waits for one of each other at most, beside those that run.
class LevelJobs {
 public:
  /// The origin of a subscription, identified by an object's address in memory; nullptr: an origin
  /// without a bound.
  using Address = const void*;
  using Done = std::move_only_function<void(Result<LevelFile>)>;
  using Maker = std::function<Result<LevelFile>(const LevelRequest&, const std::stop_token&)>;

  struct Options {
    std::size_t threads = 1;
    std::size_t most = 1;         ///< jobs waiting or running; each may hold a whole mesh in memory
    KeptAnswers* kept = nullptr;  ///< nullptr: nothing is kept; else it outlives the jobs
    Maker maker{};
    std::size_t maxOfAddress = 0;  ///< of these jobs, that one address may want; 0: no bound
  };

  explicit LevelJobs(Options options);
  /// Drops the waiting jobs (their `done` is destroyed uncalled). Asks the running ones to stop,
  /// and waits for them.
  ~LevelJobs();
  LevelJobs(const LevelJobs&) = delete;
  LevelJobs& operator=(const LevelJobs&) = delete;

  /// Somebody's subscription for a level. When it goes before `done` was called, `done` is
  /// destroyed uncalled, and with the last subscription the job ends. May outlive the jobs.
  class Subscription {
   public:
    Subscription() = default;
    Subscription(Subscription&& other) noexcept
        : withdraw_(std::exchange(other.withdraw_, nullptr)) {}
    Subscription& operator=(Subscription&& other) noexcept;
    ~Subscription();

   private:
    friend class LevelJobs;
    explicit Subscription(std::move_only_function<void()> withdraw)
        : withdraw_(std::move(withdraw)) {}
    std::move_only_function<void()> withdraw_;
  };

  /// The answer if it was kept and is at hand. Thread-safe, as all that follow.
  [[nodiscard]] KeptAnswer find(const LevelRequest& request);
  /// Whether a job for it would find it kept, and need not make it.
  [[nodiscard]] bool keeps(const LevelRequest& request) const;
  /// Has the level made and calls `done` once, on a thread of the pool. A subscription for a job
  /// that is there already is never refused. REQUIRES: `from` outlives the subscription.
  [[nodiscard]] std::expected<Subscription, LevelRefusal> submit(const LevelRequest& request,
                                                                 Done done, Address from = nullptr);
  [[nodiscard]] LevelJobCounts counts() const;
  /// Does the work of the next job on the calling thread; false: none waits. For who has no threads
  /// (`threads` = 0), or more of them.
  bool workOnce();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace qtet
