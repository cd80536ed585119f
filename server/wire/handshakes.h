// The TLS handshakes under way: how many there may be, who waits in line, and who gives way.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>

namespace qtet {

/// A queue for a bounded number of places, first come, first served. If no place is free, a client
/// that has kept one for longer than `patience` loses it to the first in line. So clients that
/// begin and do not go on cannot block others for longer. Thread-safe; must outlive its clients.
class Handshakes {
 public:
  using Clock = std::chrono::steady_clock;
  Handshakes(std::size_t most, Clock::duration patience) : most_(most), patience_(patience) {}

  struct Counts {
    std::size_t open = 0, waiting = 0;
    std::uint64_t displaced = 0;  ///< since the start
  };
  [[nodiscard]] Counts counts() const;

  class Client;

 private:
  enum class State : std::uint8_t { kNew, kWaits, kHolds, kDisplaced };
  struct Entry;
  using EntryPointer = std::shared_ptr<Entry>;
  using Line = std::list<EntryPointer>;
  struct Entry {
    boost::asio::any_io_executor executor;
    std::function<void()> wake;  // of the executor
    std::atomic<State> state = State::kNew;
    Clock::time_point since{};  // it holds a place
    Line::iterator at{};        // in `waiting_`, then in `open_`
  };

  std::optional<Clock::time_point> enter(const EntryPointer& entry);
  void leave(const EntryPointer& entry);
  void wakeFirst();
  static void wake(const EntryPointer& entry);

  const std::size_t most_;
  const Clock::duration patience_;
  mutable std::mutex mutex_;
  Line open_, waiting_;  // the oldest first
  std::uint64_t displaced_ = 0;
};

/// One handshake: in line, then with a place, which it leaves when the object goes. For its
/// connection's executor alone.
class Handshakes::Client {
 public:
  /// `wake` runs when it is worth while to enter() again, and when the place is lost.
  Client(Handshakes& handshakes, boost::asio::any_io_executor executor, std::function<void()> wake);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// nullopt: it has a place. Else it stands in line, and is to try again when it is woken, and at
  /// this time, whichever is first.
  [[nodiscard]] std::optional<Clock::time_point> enter() { return handshakes_.enter(entry_); }

 private:
  Handshakes& handshakes_;
  EntryPointer entry_;
};

}  // namespace qtet
