// The processor's time that a piece of work takes, charged to the address that it is for.
#pragma once

#include <chrono>
#include <ctime>

#include "server/wire/address_limits.h"

namespace qtet {

/// From its beginning to its end, of this thread; so not across a co_await. `payer`, which may be
/// nullptr, outlives it.
class Charge {
 public:
  explicit Charge(AddressLimits::Client* payer)
      : payer_(payer), begun_(payer != nullptr ? now() : std::chrono::nanoseconds()) {}
  ~Charge() {
    if (payer_ != nullptr) payer_->charge(now() - begun_);
  }
  Charge(const Charge&) = delete;
  Charge& operator=(const Charge&) = delete;

 private:
  [[nodiscard]] static std::chrono::nanoseconds now() {
    timespec time{};
    (void)::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }

  AddressLimits::Client* payer_;
  std::chrono::nanoseconds begun_;
};

}  // namespace qtet
