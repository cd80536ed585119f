// The processor's time that a piece of work takes, charged to the address that it is for, and
// counted if it is long.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <string_view>

#include "server/wire/address_limits.h"
#include "server/wire/connection_limits.h"
#include "server/wire/metrics.h"

namespace qtet {

/// From its beginning to its end, of this thread; so not across a co_await. `payer` and `metrics`,
/// which may be nullptr, outlive it, as the text `route` does.
///
/// A short piece of work is charged the time that passed, since a thread's own clock costs a system
/// call. A longer piece is charged at most what the thread has worked since that clock was last
/// read. That was at most kOften before the piece began.
class Charge {
 public:
  explicit Charge(AddressLimits::Client* payer, Metrics* metrics = nullptr,
                  std::string_view route = "")
      : payer_(payer), metrics_(metrics), route_(route) {
    if (payer_ == nullptr && metrics_ == nullptr) return;
    begun_ = Clock::now();
    if (begun_ - asked().at > kOften) asked() = {begun_, worked()};
  }
  ~Charge() {
    if (payer_ == nullptr && metrics_ == nullptr) return;
    std::chrono::nanoseconds time = Clock::now() - begun_;
    if (time > kShort) time = std::min(time, worked() - asked().worked);
    if (payer_ != nullptr) payer_->charge(time);
    if (metrics_ != nullptr && time > limits::kLongTurn) metrics_->countLongTurn(route_, time);
  }
  Charge(const Charge&) = delete;
  Charge& operator=(const Charge&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  /// Another thread that interrupts the work takes longer than that: a time slice.
  static constexpr std::chrono::nanoseconds kShort = std::chrono::microseconds(100);
  static constexpr std::chrono::nanoseconds kOften = std::chrono::milliseconds(1);

  struct Asked {
    Clock::time_point at{};
    std::chrono::nanoseconds worked{};
  };
  [[nodiscard]] static Asked& asked() {
    thread_local Asked out;
    return out;
  }
  [[nodiscard]] static std::chrono::nanoseconds worked() {
    timespec time{};
    (void)::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }

  AddressLimits::Client* payer_;
  Metrics* metrics_;
  std::string_view route_;
  Clock::time_point begun_{};
};

}  // namespace qtet
