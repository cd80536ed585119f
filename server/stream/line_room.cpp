#include "server/stream/line_room.h"

#include <linux/tcp.h>  // netinet/tcp.h has a tcp_info without the acknowledged bytes
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace qtet {
namespace {

using std::chrono::duration;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using Seconds = duration<double>;

/// The line time of data that may wait before the next frame. With the block begun last this stays
/// under 150 ms from 2 Mbit/s on. A server that looks a little late still keeps the line busy.
constexpr Seconds kAhead = milliseconds(40);
/// If the round trip exceeds the least one by so much, data waits in the network. Above the jitter
/// of acknowledgements; taking jitter for a queue only bounds what is under way.
constexpr Seconds kQueued = milliseconds(15);
/// Packets that may be under way however slow the line is: fewer would leave it idle while the
/// client holds its acknowledgement back.
constexpr std::uint64_t kMinPackets = 6;
/// A piece of a block has at least so many bytes: heads of frames and packets stay below 4 % then.
constexpr double kMinPiece = 4096;
/// The shortest sample of the rate. The largest of kSamples counts, so a short sample of few
/// packets overstates the rate. With 50 ms nothing bounded 20 clients of reno on 20 Mbit/s, and
/// their shares were unequal.
constexpr Seconds kMinSample = milliseconds(200);
/// Between two looks at a line without room: a timer's grain, and half of kAhead.
constexpr auto kMinWait = milliseconds(1), kMaxWait = milliseconds(20);

}  // namespace

std::optional<LineFigures> lineFigures(int socket) {
  tcp_info info{};
  socklen_t size = sizeof(info);
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0 ||
      size < offsetof(tcp_info, tcpi_delivery_rate))
    return std::nullopt;
  const microseconds rtt(info.tcpi_rtt);
  return LineFigures{
      .acknowledged = info.tcpi_bytes_acked,
      .underWay = std::uint64_t{info.tcpi_unacked} * info.tcpi_snd_mss,
      .unsent = info.tcpi_notsent_bytes,
      .packetBytes = info.tcpi_snd_mss,
      .rtt = rtt,
      .minRtt = std::min(rtt, microseconds(info.tcpi_min_rtt)),
  };
}

void LineRoom::measure(const LineFigures& line, Clock::time_point now) {
  progressed_ = line.acknowledged != acknowledged_;
  acknowledged_ = line.acknowledged;
  if (since_) {
    const Seconds passed = now - since_->time;
    if (passed < std::max(kMinSample, Seconds(line.minRtt))) return;
    samples_[next_] =
        static_cast<double>(line.acknowledged - since_->acknowledged) / passed.count();
    next_ = (next_ + 1) % kSamples;
  }
  since_ = Mark{now, line.acknowledged};
}

std::size_t LineRoom::room(const LineFigures& line, Clock::time_point now) {
  measure(line, now);
  const bool queued = line.rtt - line.minRtt > kQueued;
  double rate = *std::ranges::max_element(samples_);  // bytes a second
  // while congestion control tries out more, samples come too late
  if (!queued && line.rtt.count() > 0)
    rate = std::max(rate, static_cast<double>(line.underWay) / Seconds(line.rtt).count());
  if (rate > 0) piece_ = static_cast<std::size_t>(std::max(rate * kAhead.count(), kMinPiece));
  assert(piece_ > 0);
  const Seconds held = queued ? kAhead + Seconds(line.minRtt) : kAhead;
  const double bound =
      std::max(rate * held.count(), static_cast<double>(kMinPackets * line.packetBytes));
  const auto holds = static_cast<double>(queued ? line.underWay + line.unsent : line.unsent);
  if (holds < bound) return static_cast<std::size_t>(std::ceil(bound - holds));
  const auto excess = std::chrono::ceil<microseconds>(
      Seconds(std::min((holds - bound) / std::max(rate, 1.0), Seconds(kMaxWait).count())));
  wait_ = std::clamp<Clock::duration>(excess, kMinWait, kMaxWait);
  return 0;
}

}  // namespace qtet
