// How long a client may be silent, and how long it may take nothing of what is written to it.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace qtet {

/// Plain arithmetic on times: the owner looks at the clock.
class Patience {
 public:
  using Clock = std::chrono::steady_clock;

  Patience(Clock::duration silence, Clock::duration write, Clock::time_point now)
      : silence_(silence), write_(write), heard_(now) {}

  /// Bytes came.
  void heard(Clock::time_point now) {
    heard_ = now;
    pinged_.reset();
  }
  /// Writing begins, or what is to be written waits until the client has taken more.
  void begins(Clock::time_point now) {
    if (!writing_) writing_ = now;
  }
  /// Some of what is written was taken, which is a sign of life: a ping would wait behind it. It is
  /// none after a ping: the system takes a ping for a client that is gone.
  void took(Clock::time_point now) {
    writing_ = now;
    if (!pinged_) heard_ = now;
  }
  /// All was taken.
  void wrote() { writing_.reset(); }

  enum class Verdict : std::uint8_t {
    kWait,
    kPing,    ///< half of the silence has passed: a ping must be sent
    kSilent,  ///< it said nothing for the other half, after the ping
    kStuck,   ///< it took nothing of what is being written for too long
  };
  [[nodiscard]] Verdict at(Clock::time_point now) {
    // a ping would wait behind the data
    if (writing_) return now - *writing_ >= write_ ? Verdict::kStuck : Verdict::kWait;
    if (now - heard_ < silence_ / 2) return Verdict::kWait;
    if (!pinged_) {
      pinged_ = now;
      return Verdict::kPing;
    }
    return now - *pinged_ >= silence_ / 2 ? Verdict::kSilent : Verdict::kWait;
  }
  /// How often at() is to be asked.
  [[nodiscard]] Clock::duration interval() const { return silence_ / 2; }

 private:
  Clock::duration silence_, write_;
  Clock::time_point heard_;
  /// When the ping was due to which nothing has come since.
  std::optional<Clock::time_point> pinged_;
  /// When the client last took some of what is being written; nullopt: nothing is.
  std::optional<Clock::time_point> writing_;
};

}  // namespace qtet
