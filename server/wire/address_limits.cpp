#include <cassert>
#include <utility>  // before any Asio header: 1.74 uses std::exchange without it

#include "server/wire/address_limits.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>

#include "server/wire/connection_limits.h"

namespace qtet {
namespace {

/// A second's requests may come at once this many times over.
constexpr double kBurstSeconds = 2;
/// A longer time forgives no more, and its product might not fit: a new address was never seen.
constexpr std::chrono::duration<double> kForgetting{3600};
constexpr std::size_t kPrefixBytes = 8;  // of an IPv6 address: its /64

AddressLimits::Key keyOf(const boost::asio::ip::address& address) {
  AddressLimits::Key out{};
  if (address.is_v4()) {
    const auto bytes = address.to_v4().to_bytes();
    std::ranges::copy(bytes, out.end() - bytes.size());
  } else {
    const auto bytes = address.to_v6().to_bytes();
    std::copy_n(bytes.begin(), address.to_v6().is_v4_mapped() ? bytes.size() : kPrefixBytes,
                out.begin());
    if (address.to_v6().is_v4_mapped()) std::fill_n(out.begin(), 12, std::uint8_t{0});
  }
  return out;
}

}  // namespace

struct AddressLimits::Client::Address {
  std::mutex mutex;
  std::size_t connections = 0;
  double spent = 0;                 ///< requests that have not been forgiven yet
  std::chrono::nanoseconds owed{};  ///< processor time, likewise
  Clock::time_point last{};

  /// Forgives as many requests, and as much processor time, as the passed time allows.
  void forgive(Clock::time_point now, unsigned requestsPerSecond) {
    const std::chrono::duration<double> passed = now - last;
    spent = std::max(0.0, spent - passed.count() * requestsPerSecond);
    constexpr double kShare =
        std::chrono::duration<double>(limits::kProcessorTimePerSecond).count();
    const auto forgiven = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::min(passed, kForgetting) * kShare);
    owed = std::max(std::chrono::nanoseconds(), owed - forgiven);
    last = now;
  }
};

AddressLimits::Client::~Client() {
  const std::scoped_lock lock(address_->mutex);
  assert(address_->connections > 0);
  --address_->connections;
}

bool AddressLimits::Client::countRequest(Clock::time_point now) {
  if (bounds_.requestsPerSecond == 0) return true;
  const std::scoped_lock lock(address_->mutex);
  address_->forgive(now, bounds_.requestsPerSecond);
  if (address_->owed >= bounds_.owed) return false;
  if (address_->spent + 1 > bounds_.requestsPerSecond * kBurstSeconds) return false;
  ++address_->spent;
  return true;
}

void AddressLimits::Client::charge(std::chrono::nanoseconds time, Clock::time_point now) {
  if (bounds_.requestsPerSecond == 0) return;
  const std::scoped_lock lock(address_->mutex);
  address_->forgive(now, bounds_.requestsPerSecond);
  assert(time >= std::chrono::nanoseconds());
  address_->owed += time;
}

std::chrono::nanoseconds AddressLimits::Client::debt(Clock::time_point now) {
  if (bounds_.requestsPerSecond == 0) return {};
  const std::scoped_lock lock(address_->mutex);
  address_->forgive(now, bounds_.requestsPerSecond);
  return address_->owed;
}

bool AddressLimits::Client::overdrawn(Clock::time_point now) { return debt(now) >= bounds_.owed; }

std::unique_ptr<AddressLimits::Client> AddressLimits::enter(
    const boost::asio::ip::address& address) {
  const std::scoped_lock lock(state_->mutex);
  if (state_->addresses.size() >= limits::kMaxRememberedAddresses) forgetQuietAddresses();
  auto& ofClient = state_->addresses[keyOf(address)];
  if (!ofClient) ofClient = std::make_shared<Client::Address>();
  const std::scoped_lock one(ofClient->mutex);
  if (bounds_.connections != 0 && ofClient->connections >= bounds_.connections) return nullptr;
  ++ofClient->connections;
  return std::unique_ptr<Client>(new Client(ofClient, bounds_));
}

/// Those without a connection whose requests and time are all forgiven are as good as new ones.
void AddressLimits::forgetQuietAddresses() {
  const auto now = Clock::now();
  std::erase_if(state_->addresses, [&](const auto& entry) {
    const std::scoped_lock lock(entry.second->mutex);
    entry.second->forgive(now, bounds_.requestsPerSecond);
    return entry.second->connections == 0 && entry.second->spent == 0 &&
           entry.second->owed == std::chrono::nanoseconds();
  });
}

}  // namespace qtet
