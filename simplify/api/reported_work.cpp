#include "simplify/api/reported_work.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

namespace qtet {
namespace {

constexpr std::chrono::milliseconds kInterval{100};

/// The state that the two threads share.
struct Shared {
  std::mutex mutex;
  std::condition_variable changed;
  Stage stage = Stage::kClean;
  double fraction = 0;
  std::optional<Result<PipelineOutput>> made;
  std::exception_ptr failure;
  bool isOver = false;

  void tell(Stage now, double done) {
    const std::lock_guard lock(mutex);
    stage = now, fraction = done;
  }

  void work(TetMesh&& mesh, const PipelineOptions& options) {
    try {
      made = simplifyToLog(std::move(mesh), options);
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    isOver = true;
    changed.notify_one();
  }

  /// Reports until the work is over, or nobody wants it.
  void follow(const Tell& tell) {
    std::unique_lock lock(mutex);
    for (bool goesOn = true; goesOn && !isOver;) {
      if (changed.wait_for(lock, kInterval, [this] { return isOver; })) return;
      const Stage now = stage;
      const double done = fraction;
      lock.unlock();
      goesOn = tell(now, done);
      lock.lock();
    }
  }
};

}  // namespace

Result<PipelineOutput> simplifyAndReport(TetMesh&& mesh, PipelineOptions options,
                                         const Tell& tell) {
  Shared shared;
  std::stop_source stop;
  options.stop = stop.get_token();
  options.progress = [&](Stage stage, double fraction) { shared.tell(stage, fraction); };
  {
    const std::jthread worker([&] { shared.work(std::move(mesh), options); });
    // ends the work also where tell throws, before the thread is waited for
    struct Ending {
      std::stop_source& stop;
      ~Ending() { stop.request_stop(); }
    };
    const Ending ending{stop};
    shared.follow(tell);
  }
  if (shared.failure) std::rethrow_exception(shared.failure);
  return std::move(*shared.made);
}

}  // namespace qtet
