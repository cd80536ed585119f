// Limits for one address: connections at a time, requests a second, and processor time.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "server/wire/connection_limits.h"

namespace boost::asio::ip {
// NOLINTNEXTLINE(readability-identifier-naming): Asio's
class address;
}  // namespace boost::asio::ip

namespace qtet {

/// Thread-safe: a mutex guards the addresses, and each address its own figures. An IPv6 client
/// counts as its /64, which is what a provider gives to one.
class AddressLimits {
 public:
  using Clock = std::chrono::steady_clock;
  using Key = std::array<std::uint8_t, 16>;

  /// 0: no bound; without one of requests, there is none of processor time. A second's worth of
  /// requests may come at once, twice over.
  struct Bounds {
    std::size_t connections = 0;
    unsigned requestsPerSecond = 0;
    std::chrono::nanoseconds owed = limits::kMaxOwedTime;  ///< processor time
  };
  explicit AddressLimits(const Bounds& bounds)
      : bounds_(bounds), state_(std::make_shared<State>()) {}

  /// A connection's place among those of its address, given back when the object goes. May outlive
  /// the limits.
  class Client {
   public:
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;
    /// false: the address has asked too often, or its answers have cost too much.
    [[nodiscard]] bool countRequest(Clock::time_point now = Clock::now());
    /// Adds processor time; limits::kProcessorTimePerSecond of it is forgiven each second.
    void charge(std::chrono::nanoseconds time, Clock::time_point now = Clock::now());
    /// Processor time that is not forgiven yet; 0 without a bound.
    [[nodiscard]] std::chrono::nanoseconds debt(Clock::time_point now = Clock::now());
    /// Whether that is as much as may be; below it, an address only waits behind others (turns.h).
    [[nodiscard]] bool overdrawn(Clock::time_point now = Clock::now());
    /// The same for all clients of one address, and another for each other one; lives as long as
    /// one of them.
    [[nodiscard]] const void* address() const { return address_.get(); }

   private:
    friend class AddressLimits;
    struct Address;
    Client(std::shared_ptr<Address> address, const Bounds& bounds)
        : address_(std::move(address)), bounds_(bounds) {}
    std::shared_ptr<Address> address_;
    Bounds bounds_;
  };

  /// nullptr: the address has as many connections as it may have.
  [[nodiscard]] std::unique_ptr<Client> enter(const boost::asio::ip::address& address);

 private:
  struct State {
    std::mutex mutex;
    std::map<Key, std::shared_ptr<Client::Address>> addresses;
  };
  void forgetQuietAddresses();

  Bounds bounds_;
  std::shared_ptr<State> state_;
};

}  // namespace qtet
