// The order in which the connections of one thread have their turn.
#pragma once

#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/execution_context.hpp>
#include <chrono>
#include <functional>
#include <map>

#include "server/wire/address_limits.h"

namespace qtet {

/// A queue for each io_context. Between two turns the context looks for what has arrived: new
/// connections, and first reads. For the context's one thread alone.
class Turns : public boost::asio::execution_context::service {
 public:
  using Clock = std::chrono::steady_clock;
  using key_type = Turns;  // NOLINT(readability-identifier-naming): asked for by Asio
  static boost::asio::execution_context::id id;

  explicit Turns(boost::asio::execution_context& context)
      : boost::asio::execution_context::service(context) {}

  /// The queue of the executor's context.
  [[nodiscard]] static Turns& of(const boost::asio::any_io_executor& executor);

  /// Waits for a turn. Who comes less than `behind` later, with nothing behind, goes first.
  [[nodiscard]] boost::asio::awaitable<void> take(boost::asio::any_io_executor executor,
                                                  Clock::duration behind = {});

 private:
  void shutdown() override { waiting_.clear(); }
  void schedule(const boost::asio::any_io_executor& executor);
  void runFirst(const boost::asio::any_io_executor& executor);

  std::multimap<Clock::time_point, std::move_only_function<void()>> waiting_;
  bool scheduled_ = false;
};

/// Whether a client's address has taken so much processor time that it waits for a turn. nullptr:
/// it has no bounds.
[[nodiscard]] bool owesTurn(AddressLimits::Client* client,
                            AddressLimits::Clock::time_point now = AddressLimits::Clock::now());
/// Waits for a turn, behind those that owe less.
[[nodiscard]] boost::asio::awaitable<void> takeTurn(boost::asio::any_io_executor executor,
                                                    AddressLimits::Client* client);

}  // namespace qtet
