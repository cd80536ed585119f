// How many bytes the kernel should hold for one client: as many as the line carries in a fraction
// of a second. So a changed view takes effect soon on slow lines too.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace qtet {

/// The kernel's figures of a connection.
struct LineFigures {
  std::uint64_t acknowledged = 0;             ///< bytes so far
  std::uint64_t underWay = 0;                 ///< bytes sent and not acknowledged, by whole packets
  std::uint64_t unsent = 0;                   ///< bytes
  std::uint64_t packetBytes = 0;              ///< payload of a full packet
  std::chrono::microseconds rtt{}, minRtt{};  ///< smoothed now, and the least that was seen
};
/// nullopt if the kernel does not report them.
[[nodiscard]] std::optional<LineFigures> lineFigures(int socket);

/// Measures the rate by what is acknowledged, and bounds what is ahead of the next frame. Without a
/// queue in the network the kernel may send as much as it wants, and only the unsent bytes are
/// bounded. With one (the round trip has become longer), the bytes under way are bounded as well.
/// Else congestion control that fills queues would put seconds of data before the next frame.
/// Plain arithmetic on times: the owner looks at the clock and at the socket.
class LineRoom {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kUnbounded = std::numeric_limits<std::size_t>::max();

  /// Bytes that may be written now, 0: none before wait() has passed.
  [[nodiscard]] std::size_t room(const LineFigures& line, Clock::time_point now);
  /// Bytes of a frame that does not delay the next one for long, as of the last room(): kUnbounded
  /// while the rate is unknown.
  [[nodiscard]] std::size_t piece() const { return piece_; }
  /// How long until there may be room, after room() was 0.
  [[nodiscard]] Clock::duration wait() const { return wait_; }
  /// Whether something was acknowledged between the last two calls of room().
  [[nodiscard]] bool progressed() const { return progressed_; }
  /// There is nothing to send. Acknowledgements until the next room() say nothing about the line.
  void rests() { since_.reset(); }

 private:
  static constexpr std::size_t kSamples = 8;
  struct Mark {
    Clock::time_point time;
    std::uint64_t acknowledged;
  };
  void measure(const LineFigures& line, Clock::time_point now);

  std::optional<Mark> since_;               ///< where the sample under way began
  std::array<double, kSamples> samples_{};  ///< bytes a second, the oldest is replaced
  std::size_t next_ = 0;
  std::uint64_t acknowledged_ = 0;
  bool progressed_ = false;
  Clock::duration wait_{};
  std::size_t piece_ = kUnbounded;
};

}  // namespace qtet
