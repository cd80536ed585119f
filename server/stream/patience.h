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
  void heard(Clock::time_point now) { heard_ = now; }
  /// Writing begins, or what is to be written waits until the client has taken more.
  void begins(Clock::time_point now) {
    if (!writing_) writing_ = now;
  }
  /// The client took some of what is written, which is a sign of life like any other: its pong
  /// waits behind the data.
  void took(Clock::time_point now) { writing_ = heard_ = now; }
  /// All was taken.
  void wrote() { writing_.reset(); }

  enum class Verdict : std::uint8_t {
    kWait,
    kPing,    ///< half of the silence has passed
    kSilent,  ///< it said and took nothing for too long
    kStuck,   ///< it took nothing of what is being written for too long
  };
  [[nodiscard]] Verdict at(Clock::time_point now) const {
    // a ping would wait behind the data
    if (writing_) return now - *writing_ >= write_ ? Verdict::kStuck : Verdict::kWait;
    if (now - heard_ >= silence_) return Verdict::kSilent;
    return now - heard_ >= silence_ / 2 ? Verdict::kPing : Verdict::kWait;
  }
  /// How often at() is to be asked.
  [[nodiscard]] Clock::duration interval() const { return silence_ / 2; }

 private:
  Clock::duration silence_, write_;
  Clock::time_point heard_;
  /// When the client last took some of what is being written; nullopt: nothing is.
  std::optional<Clock::time_point> writing_;
};

}  // namespace qtet
