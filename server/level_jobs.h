// Levels are decoded and written on threads of their own, a few at a time, so that a hundred requests for one cannot stop the
// streams or fill the memory.
#pragma once

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <cstddef>
#include <functional>
#include <memory>

#include "proto/bytes.h"
#include "server/http_message.h"

namespace qtet {

/// The file of a level, whole. Errors: those of meshAtLevel and of the writers; io when there is not enough memory.
[[nodiscard]] Result<Bytes> makeLevel(const LevelRequest& request);

class LevelJobs {
 public:
  /// A place in the queue, kept until the level was sent: it bounds the memory, not only the work.
  using Place = std::shared_ptr<void>;
  using Done = std::move_only_function<void(Result<Bytes>)>;
  using Maker = std::function<Result<Bytes>(const LevelRequest&)>;

  /// `places` levels waiting, being made or being sent at a time.
  LevelJobs(std::size_t threads, std::size_t places, Maker maker = makeLevel);
  /// Drops what waits (its `done` is destroyed uncalled) and waits for what runs.
  ~LevelJobs();
  LevelJobs(const LevelJobs&) = delete;
  LevelJobs& operator=(const LevelJobs&) = delete;

  /// nullptr: all places are taken. Thread-safe.
  [[nodiscard]] Place reserve();
  /// Makes the level and calls `done` once, on a thread of the pool. REQUIRES: a place is held meanwhile. Thread-safe.
  void submit(LevelRequest request, Done done);

 private:
  Maker maker_;
  std::size_t places_;
  std::shared_ptr<std::atomic<std::size_t>> taken_ = std::make_shared<std::atomic<std::size_t>>(0);
  boost::asio::thread_pool pool_;
};

}  // namespace qtet
