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
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "server/wire/connection_limits.h"

namespace qtet {

/// A queue for a bounded number of places, first come, first served. If no place is free, a client
/// that has kept one for longer than `patience` loses it to the first in line. So clients that
/// begin and do not go on cannot block others for longer. An address has a bounded number of
/// clients with a place or in line; its further ones stand aside, and block nobody else.
/// Thread-safe: `mutex_` guards all lines. Must outlive its clients.
class Handshakes {
 public:
  using Clock = std::chrono::steady_clock;
  struct Bounds {
    std::size_t most = limits::kMaxHandshakes;
    std::size_t ofAddress = limits::kMaxHandshakesPerAddress;
    Clock::duration patience = limits::kHandshakePatience;
  };
  explicit Handshakes(const Bounds& bounds) : bounds_(bounds) {}

  struct Counts {
    std::size_t open = 0, waiting = 0;  ///< waiting: also aside
    std::uint64_t displaced = 0;        ///< since the start
  };
  [[nodiscard]] Counts counts() const;

  class Client;

 private:
  enum class State : std::uint8_t { kNew, kAside, kWaits, kHolds, kDisplaced };
  struct Entry;
  using EntryPointer = std::shared_ptr<Entry>;
  using Line = std::list<EntryPointer>;
  struct Entry {
    boost::asio::any_io_executor executor;
    std::function<void()> wake;  // of the executor
    const void* address;         // nullptr: no bound
    std::atomic<State> state = State::kNew;
    Clock::time_point since{};  // it holds a place
    Line::iterator at{};        // in its address's `aside`, in `waiting_`, then in `open_`
  };
  struct Address {
    std::size_t admitted = 0;  // of its clients are in `waiting_` or `open_`
    Line aside;                // empty unless that is as many as may be
  };

  std::optional<Clock::time_point> enter(const EntryPointer& entry);
  void leave(const EntryPointer& entry);
  void admit(const EntryPointer& entry);
  /// nullopt: it is admitted. Else when to try again.
  std::optional<Clock::time_point> waitAside(const EntryPointer& entry, Clock::time_point now);
  void displace(const EntryPointer& entry);
  /// After a client of it has left `waiting_` or `open_`.
  void admitNextOf(const void* address);
  void wakeFirst();
  static void wake(const EntryPointer& entry);

  const Bounds bounds_;
  mutable std::mutex mutex_;
  Line open_, waiting_;  // the oldest first
  std::map<const void*, Address> addresses_;
  std::size_t aside_ = 0;
  std::uint64_t displaced_ = 0;
};

/// One handshake: in line, then with a place, which it leaves when the object goes. For its
/// connection's executor alone.
class Handshakes::Client {
 public:
  /// `wake` runs when it is worth while to enter() again, and when the place is lost. `address` is
  /// the same for all clients of one address; nullptr: it has no bound.
  Client(Handshakes& handshakes, boost::asio::any_io_executor executor, std::function<void()> wake,
         const void* address = nullptr);
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
