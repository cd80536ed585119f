// What one address may take of the server: connections at a time, and requests a second.
#pragma once

#include <array>
#include <boost/asio/ip/address.hpp>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

namespace qtet {

/// Thread-safe. An IPv6 client counts as its /64, which is what a provider gives to one.
class AddressLimits {
 public:
  using Clock = std::chrono::steady_clock;
  using Key = std::array<std::uint8_t, 16>;

  /// 0: no bound. A second's worth of requests may come at once, twice over.
  AddressLimits(std::size_t mostConnections, unsigned requestsPerSecond)
      : mostConnections_(mostConnections), requestsPerSecond_(requestsPerSecond), state_(std::make_shared<State>()) {}

  /// A connection's place among those of its address, given back when the object goes. May outlive the limits.
  class Visitor {
   public:
    ~Visitor();
    Visitor(const Visitor&) = delete;
    Visitor& operator=(const Visitor&) = delete;
    /// false: the address has asked too often.
    [[nodiscard]] bool countRequest(Clock::time_point now = Clock::now());
    /// The same for all visitors of one address, and another for each other one; lives as long as one of them.
    [[nodiscard]] const void* address() const { return host_.get(); }

   private:
    friend class AddressLimits;
    struct Host;
    Visitor(std::shared_ptr<Host> host, unsigned requestsPerSecond) : host_(std::move(host)), requestsPerSecond_(requestsPerSecond) {}
    std::shared_ptr<Host> host_;
    unsigned requestsPerSecond_;
  };

  /// nullptr: the address has as many connections as it may have.
  [[nodiscard]] std::unique_ptr<Visitor> enter(const boost::asio::ip::address& address);

 private:
  struct State {
    std::mutex mutex;
    std::map<Key, std::shared_ptr<Visitor::Host>> hosts;
  };
  void forgetQuietHosts();

  std::size_t mostConnections_;
  unsigned requestsPerSecond_;
  std::shared_ptr<State> state_;
};

}  // namespace qtet
