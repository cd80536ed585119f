// How long a client may be silent, and how long it may take nothing of what is written to it.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace qtet {

/// Plain arithmetic on times: whoever holds it looks at the clock.
class Patience {
 public:
  using Clock = std::chrono::steady_clock;

  Patience(Clock::duration silence, Clock::duration write, Clock::time_point now)
      : silence_(silence), write_(write), heard_(now) {}

  /// Bytes came.
  void heard(Clock::time_point now) { heard_ = now; }
  /// Writing begins, or the client took some of what is written.
  void took(Clock::time_point now) { writing_ = now; }
  /// All was taken.
  void wrote() { writing_.reset(); }

  enum class Verdict : std::uint8_t {
    kWait,
    kPing,    ///< half of the silence has passed
    kGiveUp,  ///< it was silent, or took nothing, for too long
  };
  [[nodiscard]] Verdict at(Clock::time_point now) const {
    const bool stuck = writing_ && now - *writing_ >= write_;
    if (stuck || now - heard_ >= silence_) return Verdict::kGiveUp;
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
