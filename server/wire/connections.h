// The open connections. Bounds their number, and notifies each when the server ends.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

namespace qtet {

/// One connection's place among the open ones, given back when the object goes; and its ear for the
/// server's end. All but `requestEnd` belongs to the connection's own executor.
class Connection {
 public:
  explicit Connection(boost::asio::any_io_executor executor) : executor_(std::move(executor)) {}

  /// Whether the server is ending: answer what is under way and begin nothing new.
  [[nodiscard]] bool ending() const { return ending_; }
  /// `wake` runs when the end is requested, to interrupt what waits for the client; an empty one
  /// forgets it.
  void onEnd(std::function<void()> wake) { wake_ = std::move(wake); }
  /// Thread-safe.
  static void requestEnd(const std::shared_ptr<Connection>& connection);

 private:
  boost::asio::any_io_executor executor_;
  std::function<void()> wake_;
  bool ending_ = false;
};

/// Thread-safe: `mutex_` guards the list. Must outlive the connections that it hands out.
class Connections {
 public:
  explicit Connections(std::size_t most) : most_(most) {}

  /// nullptr: there are as many as there may be, or the server ends.
  [[nodiscard]] std::shared_ptr<Connection> enter(boost::asio::any_io_executor executor);
  [[nodiscard]] std::size_t open() const;
  /// Asks every connection to end, admits no other, and calls `whenEmpty` once when the last has
  /// gone (perhaps at once).
  void endAll(std::function<void()> whenEmpty);

 private:
  void leave(std::uint64_t number);

  const std::size_t most_;
  mutable std::mutex mutex_;
  std::uint64_t entered_ = 0;
  std::map<std::uint64_t, std::weak_ptr<Connection>> open_;  // by the order in which they entered
  bool ending_ = false;
  std::function<void()> whenEmpty_;
};

}  // namespace qtet
